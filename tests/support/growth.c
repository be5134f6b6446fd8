/* SPDX-License-Identifier: MIT */
#include "growth.h"

#include <float.h>

bool grows_slowly(growth_work work, size_t size)
{
	enum { TRIES = 8, TIMES = 8, MOST = 36 };
	double small = DBL_MAX, large = DBL_MAX;
	for (int i = 0; i < TRIES; i++) {
		const double s = work(size), l = work(TIMES * size);
		small = s < small ? s : small;
		large = l < large ? l : large;
		if (large < MOST * small)
			return true;
	}
	return false;
}
