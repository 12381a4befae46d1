/* SPDX-License-Identifier: MIT
 * What builds without cairo have in place of study_charts_pdf.c and study_sheets.c. */
#include "study_charts.h"
#include "study_sheets.h"

#include "message.h"

int study_charts_write(const study_record *record)
{
    (void)record;
    return EXIT_CODE_OK;
}

int study_sheets_write(const study_record *record)
{
    (void)record;
    return EXIT_CODE_OK;
}
