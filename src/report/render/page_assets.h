/* SPDX-License-Identifier: MIT */
/*
 * Files that go into an HTML report, NUL-terminated.
 */
#ifndef NT_REPORT_RENDER_PAGE_ASSETS_H
#define NT_REPORT_RENDER_PAGE_ASSETS_H

extern const char nt_page_style[];  /* page/page.css */
extern const char nt_page_body[];   /* page/page.html: what is inside the body */
extern const char nt_page_script[]; /* the scripts in page/, in order */

#endif
