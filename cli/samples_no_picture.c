/* SPDX-License-Identifier: MIT
 * What builds without cairo have in place of the figures of samples: none is ever asked for. */
#include "figure_path.h"
#include "samples.h"

int samples_draw(const char *path, const samples_view *view)
{
    (void)view;
    return figure_path_check("out", path, "samples");
}

samples_sheet *samples_sheet_make(const char *path, uint64_t total)
{
    (void)path, (void)total;
    return NULL;
}

void samples_sheet_release(samples_sheet *sheet)
{
    (void)sheet;
}

bool samples_sheet_wants(const samples_sheet *sheet, uint64_t position)
{
    (void)sheet, (void)position;
    return false;
}

bool samples_sheet_is_full(const samples_sheet *sheet)
{
    (void)sheet;
    return true;
}

void samples_sheet_add(samples_sheet *sheet, const samples_view *view)
{
    (void)sheet, (void)view;
}

int samples_sheet_write(const samples_sheet *sheet)
{
    (void)sheet;
    return figure_path_check("contact-sheet", "", "samples");
}
