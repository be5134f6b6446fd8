#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Confirms signs and frames of single triangles in rational arithmetic.

usage: check_fractions.py samples.txt

Each line is a triangle and the library's answers (see sample.h). The sign of the UV determinant and the
direction of dP/du, projected along the normal, are exact fractions here; only the last step, the division by a
length, takes a root, of integers with 120 digits. Ends with 1 when a sign is wrong or a component is further
than 2^-23 from the exact one where the projection keeps more than 2^-24.
"""
import math
import sys
from fractions import Fraction

ONE_BIT = Fraction(1, 2 ** 23)
SCALE = 10 ** 60


def root(x):
	"""The square root of a fraction, to 60 digits."""
	shift = 1
	while x * shift * shift < 1:
		shift *= 2 ** 64
	return Fraction(math.isqrt(int(x * shift * shift * SCALE * SCALE)), SCALE * shift)


def dot(a, b):
	return sum(x * y for x, y in zip(a, b))


def minus(a, b):
	return [x - y for x, y in zip(a, b)]


def judge(words):
	"""What is wrong with one line, or None; and whether its vectors could be judged."""
	values = [float.fromhex(w) for w in words[:24]]
	sign = int(words[24])
	tangents = [float.fromhex(w) for w in words[25:37]]
	finite_uv = all(math.isfinite(values[8 * k + i]) for k in range(3) for i in (6, 7))
	if not finite_uv:
		return ("a sign from values that are not finite" if sign else None), False
	corner = [values[8 * k:8 * k + 8] for k in range(3)]
	t = [[Fraction(x) for x in c[6:8]] for c in corner]
	b, c = minus(t[1], t[0]), minus(t[2], t[0])
	determinant = b[0] * c[1] - b[1] * c[0]
	if (determinant > 0) - (determinant < 0) != sign:
		return "wrong sign", False
	if not all(math.isfinite(x) for x in values) or sign == 0:
		return None, False
	p = [[Fraction(x) for x in k[0:3]] for k in corner]
	d1, d2 = minus(p[1], p[0]), minus(p[2], p[0])
	u = [sign * (c[1] * x - b[1] * y) for x, y in zip(d1, d2)]
	if len({tuple(x) for x in map(tuple, p)}) < 3 or dot(u, u) == 0:
		return None, False
	judged = False
	for k in range(3):
		n = [Fraction(x) for x in corner[k][3:6]]
		nn = dot(n, n)
		if nn == 0:
			continue
		# the angle at the corner must not vanish, or the sum there has no weight
		e, f = minus(p[(k + 1) % 3], p[k]), minus(p[(k + 2) % 3], p[k])
		across = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]
		sine = dot(n, across)
		if sine * sine * 2 ** 80 < nn * dot(e, e) * dot(f, f):
			continue
		projected = [x - y * dot(n, u) / nn for x, y in zip(u, n)]
		if dot(projected, projected) * 2 ** 44 < dot(u, u):
			continue
		length = root(dot(projected, projected))
		if tangents[4 * k + 3] != sign:
			return "wrong w", judged
		for x, got in zip(projected, tangents[4 * k:4 * k + 3]):
			if not math.isfinite(got) or abs(x / length - Fraction(got)) > ONE_BIT:
				return "component off at corner %d" % k, judged
		judged = True
	return None, judged


def main():
	signs = frames = wrong = 0
	with open(sys.argv[1], encoding="ascii") as lines:
		for number, line in enumerate(lines, 1):
			fault, judged = judge(line.split())
			signs += 1
			frames += judged
			if fault:
				wrong += 1
				print("check_fractions: line %d: %s" % (number, fault))
	print("check_fractions: %d signs and %d frames confirmed, %d wrong" % (signs - wrong, frames, wrong))
	return 1 if wrong or not frames else 0


if __name__ == "__main__":
	sys.exit(main())
