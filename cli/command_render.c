/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "interrupt.h"
#include "message.h"
#include "render_job.h"
#include "render_sequence.h"

int command_render(const cli_options *options)
{
    interrupt_install();
    render_job job;
    int code = render_job_open(&job, options);
    if (code == EXIT_CODE_OK)
        code = render_sequence_run(&job);
    render_job_close(&job);
    return code;
}
