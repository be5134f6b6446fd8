/* SPDX-License-Identifier: MIT */
/*
 * JPEG by libjpeg-turbo: grey stays grey, everything else becomes RGB. The library leaves by longjmp; nothing between
 * setjmp and there owns memory that is not reachable from the state below.
 *
 * A file that ends early, or whose data is damaged, would give an image with grey areas; that is an error. The scans of
 * a progressive file are counted: each goes over the whole image, and a file of some kilobytes can have thousands.
 */
#include "ext/codec/pixels.h"

#include <setjmp.h>
#include <stdio.h> /* before jpeglib.h, which does not include it */
#include <jpeglib.h>
#include <jerror.h>

enum { MOST_SCANS = 500, SLACK_BYTES = 131072 };

typedef struct decoder {
	struct jpeg_decompress_struct jpeg;
	struct jpeg_error_mgr errors;
	struct jpeg_progress_mgr progress;
	nt_pixels *pixels;
	nt_error *error;
	jmp_buf leave;
} decoder;

static void leave(j_common_ptr jpeg)
{
	decoder *d = jpeg->client_data;
	char text[JMSG_LENGTH_MAX];
	jpeg->err->format_message(jpeg, text);
	if (jpeg->err->msg_code == JERR_OUT_OF_MEMORY)
		nt_fail_memory(d->error);
	else
		nt_fail(d->error, NT_ERROR_INPUT, "JPEG: %s", text);
	longjmp(d->leave, 1);
}

/* Level -1 is a warning; the library goes on with what it has. */
static void on_message(j_common_ptr jpeg, int level)
{
	if (level < 0 && (jpeg->err->msg_code == JWRN_JPEG_EOF || jpeg->err->msg_code == JWRN_HIT_MARKER))
		leave(jpeg);
}

static void on_progress(j_common_ptr jpeg)
{
	decoder *d = jpeg->client_data;
	if (d->jpeg.input_scan_number <= MOST_SCANS)
		return;
	nt_fail(d->error, NT_ERROR_UNSUPPORTED, "JPEG: more than %d scans", MOST_SCANS);
	longjmp(d->leave, 1);
}

/* A Huffman code has a bit at least, and each block of each component has one, of its first coefficient. Arithmetic
 * coding has no such bound. The coefficients of several scans, which libjpeg keeps at once, take 128 bytes for each
 * block, 1 KB for each byte of the file: there, its images may be as large as if some bytes more were in it. */
static bool is_too_small(struct jpeg_decompress_struct *jpeg, size_t size)
{
	uint64_t blocks = 0;
	for (int i = 0; i < jpeg->num_components; i++)
		blocks += (uint64_t)jpeg->comp_info[i].width_in_blocks * jpeg->comp_info[i].height_in_blocks;
	return jpeg->arith_code ? jpeg_has_multiple_scans(jpeg) && blocks / 8 > (uint64_t)size + SLACK_BYTES :
				  blocks / 8 > size;
}

static void decode(decoder *d, const unsigned char *bytes, size_t size, uint32_t rows)
{
	struct jpeg_decompress_struct *jpeg = &d->jpeg;
	jpeg_create_decompress(jpeg);
	jpeg->client_data = d;
	d->progress.progress_monitor = on_progress;
	jpeg->progress = &d->progress;
	jpeg_mem_src(jpeg, bytes, size);
	jpeg_read_header(jpeg, TRUE);
	if (is_too_small(jpeg, size)) {
		nt_fail(d->error, NT_ERROR_INPUT, "JPEG: %zu bytes cannot hold %u x %u pixels", size, jpeg->image_width,
			jpeg->image_height);
		longjmp(d->leave, 1);
	}
	jpeg->out_color_space = jpeg->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
	jpeg->dct_method = JDCT_ISLOW;
	const bool all = rows >= jpeg->image_height;
	const unsigned channels = jpeg->num_components == 1 ? 1 : 3;
	if (nt_pixels_check(jpeg->image_width, jpeg->image_height, channels, 8, d->error) ||
		nt_pixels_create(d->pixels, jpeg->image_width, all ? jpeg->image_height : rows, channels, 8, d->error))
		longjmp(d->leave, 1);
	jpeg_start_decompress(jpeg);
	while (jpeg->output_scanline < d->pixels->height) {
		JSAMPROW row = (JSAMPROW)d->pixels->samples + jpeg->output_scanline * nt_pixels_row_bytes(d->pixels);
		jpeg_read_scanlines(jpeg, &row, 1);
	}
	if (all)
		jpeg_finish_decompress(jpeg);
}

nt_status nt_decode_jpeg(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	nt_error failure;
	decoder d = {.pixels = pixels, .error = error ? error : &failure};
	*pixels = (nt_pixels){0};
	d.jpeg.err = jpeg_std_error(&d.errors);
	d.jpeg.client_data = &d; /* jpeg_create_decompress may fail already, and keeps it */
	d.errors.error_exit = leave;
	d.errors.emit_message = on_message;
	if (setjmp(d.leave)) {
		jpeg_destroy_decompress(&d.jpeg);
		nt_pixels_free(pixels);
		return d.error->status;
	}
	decode(&d, bytes, size, rows);
	jpeg_destroy_decompress(&d.jpeg);
	return NT_OK;
}
