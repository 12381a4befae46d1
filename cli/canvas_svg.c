/* SPDX-License-Identifier: MIT */
#include "canvas.h"

#include <stdio.h>
#include <string.h>

void canvas_write_escaped(void *stream, const char *text)
{
    for (; *text != 0; text++)
        switch (*text) {
        case '<': fputs("&lt;", stream); break;
        case '>': fputs("&gt;", stream); break;
        case '&': fputs("&amp;", stream); break;
        case '"': fputs("&quot;", stream); break;
        default: fputc((unsigned char)*text < 32 ? ' ' : *text, stream);
        }
}

static void draw_line(canvas *on, const canvas_stroke *stroke, const double (*points)[2], size_t count)
{
    FILE *stream = on->data;
    fputs("<polyline fill=\"none\" points=\"", stream);
    for (size_t i = 0; i < count; i++)
        fprintf(stream, "%s%.2f,%.2f", i > 0 ? " " : "", points[i][0], points[i][1]);
    fprintf(stream, "\" stroke=\"#%06x\" stroke-width=\"%g\"", stroke->colour, stroke->width);
    if (stroke->dash > 0)
        fprintf(stream, " stroke-dasharray=\"%g\"", stroke->dash);
    fputs("/>\n", stream);
}

static void draw_dot(canvas *on, uint32_t colour, double x, double y, double radius)
{
    fprintf(on->data, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" fill=\"#%06x\"/>\n", x, y, radius, colour);
}

static void draw_text(canvas *on, const canvas_text *style, double x, double y, const char *text)
{
    static const char *const anchors[] = {[CANVAS_START] = "start", [CANVAS_MIDDLE] = "middle", [CANVAS_END] = "end"};
    FILE *stream = on->data;
    fprintf(stream, "<text x=\"%.2f\" y=\"%.2f\" fill=\"#%06x\" font-size=\"%g\" text-anchor=\"%s\"", x, y,
            style->colour, style->size, anchors[style->align]);
    if (style->bold)
        fputs(" font-weight=\"bold\"", stream);
    if (style->upwards)
        fprintf(stream, " transform=\"rotate(-90 %.2f %.2f)\"", x, y);
    fputc('>', stream);
    canvas_write_escaped(stream, text);
    fputs("</text>\n", stream);
}

canvas canvas_on_svg(void *stream)
{
    return (canvas){draw_line, draw_dot, draw_text, stream};
}
