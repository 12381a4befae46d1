/* SPDX-License-Identifier: MIT */
#include "reference_plan.h"

#include "message.h"

#include <stddef.h>
#include <string.h>

enum { PAPER_SPP = 655000 };

static const char *usual_out(void)
{
    return helio_picture_check_path("reference.exr") == HELIO_OK ? "reference.exr" : "reference.pfm";
}

static int check_quadrature(const reference_options *own, const cli_options *options)
{
    if (own->spp != 0 || own->seconds > 0)
        return message_usage("--method quadrature takes no samples, and is done when all pixels are; leave --%s away",
                             own->spp != 0 ? "spp" : "time");
    if (options->visibility[0] != 'n')
        return message_usage("--method quadrature sums all light and traces no rays, so nothing would cast a shadow; "
                             "give --visibility none, or --method cosine");
    return EXIT_CODE_OK;
}

int reference_plan_make(reference_plan *plan, const cli_options *options)
{
    const reference_options *own = &options->truth;
    *plan = (reference_plan){
        .render = *options,
        .spp = own->spp,
        .seconds = own->seconds,
        .error = own->error,
        .save_ms = own->save_every * 1e3,
        .resume = own->resume,
        .keep_checkpoint = own->keep_checkpoint,
    };
    plan->render.out = own->out != NULL ? own->out : usual_out();
    plan->render.strategy = own->strategy != NULL ? own->strategy : "cosine";
    plan->render.spp = 0; /* of a pass: the library's choice */
    if (own->method != NULL && own->strategy != NULL)
        return message_usage("--method and --strategy both say how light is found; give one of them");
    if (own->method != NULL && strcmp(own->method, "quadrature") == 0) {
        plan->method = HELIO_REFERENCE_QUADRATURE;
        return check_quadrature(own, options);
    }
    if (plan->spp == 0 && plan->seconds == 0 && plan->error == 0)
        plan->spp = PAPER_SPP;
    return EXIT_CODE_OK;
}

const char *reference_plan_name(const reference_plan *plan)
{
    return plan->method == HELIO_REFERENCE_QUADRATURE ? "quadrature" : plan->render.strategy;
}
