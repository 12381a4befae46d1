/* SPDX-License-Identifier: MIT */
#include "contact_sheet.h"

#include "sheet_labels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THUMB_EDGE = 320, CELL_EDGE = 96, GAP = 8 };
static const float PAPER = 0.02F; /* dark grey */

/* ---- which frames ------------------------------------------------------------------------ */

bool contact_sheet_make(contact_sheet *sheet, uint32_t width, uint32_t height, uint64_t total)
{
    uint32_t edge = width > height ? width : height;
    double scale = edge > THUMB_EDGE ? (double)THUMB_EDGE / edge : 1;
    *sheet = (contact_sheet){.total = total, .stride = 1};
    sheet->thumb_width = (uint32_t)fmax(floor(width * scale), 1);
    sheet->thumb_height = (uint32_t)fmax(floor(height * scale), 1);
    for (int i = 0; i < SHEET_CELLS; i++) {
        float *rgb = malloc((size_t)sheet->thumb_width * sheet->thumb_height * 3 * sizeof rgb[0]);
        if (rgb == NULL) {
            contact_sheet_release(sheet);
            return false;
        }
        sheet->cells[i].rgb = rgb;
    }
    return true;
}

void contact_sheet_release(contact_sheet *sheet)
{
    for (int i = 0; i < SHEET_CELLS; i++)
        free(sheet->cells[i].rgb);
    *sheet = (contact_sheet){0};
}

/* Of a known number the first, the last, and as even as can be between them. */
bool contact_sheet_wants(const contact_sheet *sheet, uint64_t position)
{
    if (sheet->total == 0)
        return position % sheet->stride == 0;
    if (sheet->total <= SHEET_CELLS || sheet->count >= SHEET_CELLS)
        return sheet->count < SHEET_CELLS;
    double next = (double)sheet->count * (double)(sheet->total - 1) / (SHEET_CELLS - 1);
    return position >= (uint64_t)floor(next + 0.5);
}

/* Every second frame goes, and from now on every second one that would have come. */
static void thin_out(contact_sheet *sheet)
{
    for (uint32_t i = 1; 2 * i < sheet->count; i++) {
        contact_sheet_cell cell = sheet->cells[i];
        sheet->cells[i] = sheet->cells[2 * i];
        sheet->cells[2 * i] = cell;
    }
    sheet->count = (sheet->count + 1) / 2;
    sheet->stride *= 2;
}

/* ---- thumbnails -------------------------------------------------------------------------- */

void contact_sheet_add(contact_sheet *sheet, const shown_picture *picture, const char *label)
{
    if (sheet->count == SHEET_CELLS)
        thin_out(sheet);
    contact_sheet_cell *cell = &sheet->cells[sheet->count++];
    snprintf(cell->label, sizeof cell->label, "%s", label);
    shown_picture_shrink(picture, sheet->thumb_width, sheet->thumb_height, cell->rgb);
}

/* ---- the sheet --------------------------------------------------------------------------- */

typedef struct sheet_shape {
    uint32_t columns, rows, cell_width, cell_height, width, height;
} sheet_shape;

static sheet_shape find_shape(const contact_sheet *sheet)
{
    sheet_shape shape = {.columns = sheet->count < SHEET_COLUMNS ? sheet->count : SHEET_COLUMNS};
    shape.rows = (sheet->count + shape.columns - 1) / shape.columns;
    shape.cell_width = sheet->thumb_width > CELL_EDGE ? sheet->thumb_width : CELL_EDGE;
    shape.cell_height = sheet->thumb_height + SHEET_LABEL_HEIGHT;
    shape.width = GAP + shape.columns * (shape.cell_width + GAP);
    shape.height = GAP + shape.rows * (shape.cell_height + GAP);
    return shape;
}

static void paste(const contact_sheet *sheet, const contact_sheet_cell *cell, float *place, uint32_t width)
{
    const float *rgb = cell->rgb;
    for (uint32_t row = 0; row < sheet->thumb_height; row++)
        for (uint32_t column = 0; column < sheet->thumb_width; column++, rgb += 3)
            memcpy(place + ((size_t)row * width + column) * 4, rgb, 3 * sizeof rgb[0]);
}

static void fill_sheet(const contact_sheet *sheet, const sheet_shape *shape, float *rgba)
{
    sheet_label labels[SHEET_CELLS];
    for (size_t i = 0; i < (size_t)shape->width * shape->height * 4; i++)
        rgba[i] = i % 4 == 3 ? 1 : PAPER;
    for (uint32_t i = 0; i < sheet->count; i++) {
        uint32_t x = GAP + i % shape->columns * (shape->cell_width + GAP);
        uint32_t y = GAP + i / shape->columns * (shape->cell_height + GAP);
        uint32_t margin = (shape->cell_width - sheet->thumb_width) / 2;
        paste(sheet, &sheet->cells[i], rgba + ((size_t)y * shape->width + x + margin) * 4, shape->width);
        labels[i] = (sheet_label){
            .text = sheet->cells[i].label, .middle = x + shape->cell_width / 2.0, .top = y + sheet->thumb_height};
    }
    sheet_labels_draw(labels, sheet->count, shape->width, shape->height, rgba);
}

helio_status contact_sheet_write(const contact_sheet *sheet, helio_context *context, const char *path)
{
    sheet_shape shape = find_shape(sheet);
    float *rgba = malloc((size_t)shape.width * shape.height * 4 * sizeof rgba[0]);
    if (rgba == NULL)
        return HELIO_ERR_MEMORY;
    fill_sheet(sheet, &shape, rgba);
    const helio_picture picture = {.width = shape.width, .height = shape.height, .rgba = rgba};
    helio_status status = helio_picture_write(context, path, &picture, NULL);
    free(rgba);
    return status;
}
