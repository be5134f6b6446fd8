/* SPDX-License-Identifier: MIT */
/*
 * Reading decimal numbers, by fast_float: correctly rounded, independent of the locale.
 */
#ifndef NT_EXT_NUMBER_H
#define NT_EXT_NUMBER_H

#ifdef __cplusplus
extern "C" {
#endif

/* Reads a number at [begin, end): optional sign ('+' too), digits, point, exponent, inf, nan. Returns
 * where it ends, NULL when there is no number. Overflow gives infinity, underflow zero. */
const char *nt_read_float(const char *begin, const char *end, float *value);
const char *nt_read_double(const char *begin, const char *end, double *value);

#ifdef __cplusplus
}
#endif
#endif
