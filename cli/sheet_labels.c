/* SPDX-License-Identifier: MIT */
#include "sheet_labels.h"

#ifdef HELIO_WITH_CAIRO

#include <cairo.h>

static const double TEXT_SIZE = 14;
static const float INK = 0.6F;

static void draw_masks(cairo_surface_t *surface, const sheet_label *labels, size_t count)
{
    cairo_t *cairo = cairo_create(surface);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, TEXT_SIZE);
    for (size_t i = 0; i < count; i++) {
        cairo_text_extents_t extents;
        cairo_text_extents(cairo, labels[i].text, &extents);
        cairo_move_to(cairo, labels[i].middle - extents.x_advance / 2, labels[i].top + SHEET_LABEL_HEIGHT - 6);
        cairo_show_text(cairo, labels[i].text);
    }
    cairo_destroy(cairo);
}

static void blend(cairo_surface_t *surface, uint32_t width, uint32_t height, float *rgba)
{
    cairo_surface_flush(surface);
    const unsigned char *masks = cairo_image_surface_get_data(surface);
    size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    for (uint32_t row = 0; masks != NULL && row < height; row++)
        for (uint32_t column = 0; column < width; column++, rgba += 4) {
            float share = (float)masks[row * stride + column] / 255;
            for (int c = 0; c < 3; c++)
                rgba[c] += (INK - rgba[c]) * share;
        }
}

void sheet_labels_draw(const sheet_label *labels, size_t count, uint32_t width, uint32_t height, float *rgba)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, (int)width, (int)height);
    if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
        draw_masks(surface, labels, count);
        blend(surface, width, height, rgba);
    }
    cairo_surface_destroy(surface);
}

#else

void sheet_labels_draw(const sheet_label *labels, size_t count, uint32_t width, uint32_t height, float *rgba)
{
    (void)labels, (void)count, (void)width, (void)height, (void)rgba;
}

#endif
