/* SPDX-License-Identifier: MIT */
/*
 * Identity of meshes and findings whose names have changed: their geometry. The same in every run.
 */
#ifndef NT_REPORT_DIGEST_H
#define NT_REPORT_DIGEST_H

#include "report/report.h"
#include "report/surface/surface.h"

/* The digest of a mesh's triangles in space, whatever their order and numbers. Never 0. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_digest_surface(const nt_surface *surface, nt_scratch *scratch, uint64_t *digest);

/* The digest of a finding, before its mesh is known as a whole: its code and its places, or, without places, its
 * detail. */
uint64_t nt_digest_finding(const nt_report_finding *finding, const char *detail);

/* Completes the digests of findings without places, which are about a mesh or the file: 0 where that has no
 * triangles. */
void nt_digest_complete(nt_report *report);

#endif
