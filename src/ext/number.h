/* SPDX-License-Identifier: MIT */
/*
 * Reading and writing decimal numbers, by fast_float and the C++ library: correctly rounded,
 * independent of the locale.
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

/* Writes the shortest decimal text that reads back as the same float ("nan", "inf" and "-inf" where it
 * is no number), without a final NUL. Returns where it ends; text has room for NT_FLOAT_TEXT - 1 bytes. */
#define NT_FLOAT_TEXT 24
char *nt_write_float(char *text, float value);

/* The same as JSON, of the shortest text of a float and of a double: with a point or an exponent always, 0.8,
 * 1.0, 1e-05, 1.5e+20; and null where it is no number. text has room for NT_NUMBER_TEXT bytes. */
#define NT_NUMBER_TEXT 32
char *nt_write_json_float(char *text, float value);
char *nt_write_json_double(char *text, double value);

#ifdef __cplusplus
}
#endif
#endif
