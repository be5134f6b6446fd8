/* SPDX-License-Identifier: MIT */
/*
 * Random settings of a run: for damaged and made-up inputs.
 */
#ifndef NT_SUPPORT_ANY_SETTINGS_H
#define NT_SUPPORT_ANY_SETTINGS_H

#include "pipeline/run.h"

/*
 *   input    its name says whether it is glTF, which has options of its own
 *   chance   as mutate_random() takes it; the same gives the same
 *   report   what a report is to hold, if the settings have one
 *   output   receives the name that the output shall have
 *
 * One thread. A check has no output_format, all others have.
 */
nt_settings any_settings(const char *input, uint32_t *chance, const nt_report_options *report, const char **output);

#endif
