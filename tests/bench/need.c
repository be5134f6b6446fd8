/* SPDX-License-Identifier: MIT */
/*
 * Prints how many bytes src/batch/gate.c guesses that a run takes: need [OPTIONS] INPUT OUTPUT
 */
#include <inttypes.h>
#include <stdio.h>
#include "batch/inside.h"
#include "cli/options.h"

int main(int argc, char **argv)
{
	nt_command command;
	nt_error error;
	if (nt_options_parse(argc, argv, &command, &error)) {
		fprintf(stderr, "%s\n", error.message);
		return 1;
	}
	printf("%" PRIu64 "\n", nt_need_of(command.operands[0], &command.settings, 0));
	return 0;
}
