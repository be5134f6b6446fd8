/* SPDX-License-Identifier: MIT */
/*
 * JPEG by libjpeg-turbo: grey stays grey, everything else becomes RGB. The library leaves by longjmp; nothing between
 * setjmp and there owns memory that is not reachable from the state below.
 *
 * A file that ends early, or whose data is damaged, would give an image with grey areas; that is an error. The scans of
 * a progressive file are counted: each goes over the whole image, and a file of some kilobytes can have thousands.
 *
 * JPEGs that are written are for looking at. The same samples give the same bytes: the library's vector code for the
 * exact integer transform has the results of its scalar code.
 */
#include "ext/codec/pixels.h"

#include <setjmp.h>
#include <stdlib.h>
#include <stdio.h> /* before jpeglib.h, which does not include it */
#include <jpeglib.h>
#include <jerror.h>
#include "base/memory.h"

enum { MOST_SCANS = 500, SLACK_BYTES = 131072 };

/* The library's client_data. */
typedef struct session {
	struct jpeg_error_mgr errors;
	nt_error *error;
	jmp_buf leave;
} session;

typedef struct decoder {
	session session; /* first */
	struct jpeg_decompress_struct jpeg;
	struct jpeg_progress_mgr progress;
	nt_pixels *pixels;
} decoder;

static void leave(j_common_ptr jpeg)
{
	session *s = jpeg->client_data;
	char text[JMSG_LENGTH_MAX];
	jpeg->err->format_message(jpeg, text);
	if (jpeg->err->msg_code == JERR_OUT_OF_MEMORY)
		nt_fail_memory(s->error);
	else
		nt_fail(s->error, NT_ERROR_INPUT, "JPEG: %s", text);
	longjmp(s->leave, 1);
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
	nt_fail(d->session.error, NT_ERROR_UNSUPPORTED, "JPEG: more than %d scans", MOST_SCANS);
	longjmp(d->session.leave, 1);
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

static void decode(decoder *d, const unsigned char *bytes, size_t size, uint32_t rows, uint32_t least)
{
	struct jpeg_decompress_struct *jpeg = &d->jpeg;
	jpeg_create_decompress(jpeg);
	jpeg->client_data = d;
	d->progress.progress_monitor = on_progress;
	jpeg->progress = &d->progress;
	jpeg_mem_src(jpeg, bytes, size);
	jpeg_read_header(jpeg, TRUE);
	if (is_too_small(jpeg, size)) {
		nt_fail(d->session.error, NT_ERROR_INPUT, "JPEG: %zu bytes cannot hold %u x %u pixels", size,
			jpeg->image_width, jpeg->image_height);
		longjmp(d->session.leave, 1);
	}
	jpeg->out_color_space = jpeg->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
	jpeg->dct_method = JDCT_ISLOW;
	/* of a half, a quarter and an eighth the least whose longer side is `least` or more */
	jpeg->scale_denom = 16;
	do {
		jpeg->scale_denom /= 2;
		jpeg_calc_output_dimensions(jpeg);
	} while (jpeg->scale_denom > 1 && jpeg->output_width < least && jpeg->output_height < least);
	const uint32_t width = jpeg->output_width, height = jpeg->output_height;
	const bool all = rows >= height;
	const unsigned channels = jpeg->num_components == 1 ? 1 : 3;
	nt_error *error = d->session.error;
	if (nt_pixels_check(jpeg->image_width, jpeg->image_height, channels, 8, error) ||
		nt_pixels_create(d->pixels, width, all ? height : rows, channels, 8, error))
		longjmp(d->session.leave, 1);
	d->pixels->lossy = true;
	jpeg_start_decompress(jpeg);
	while (jpeg->output_scanline < d->pixels->height) {
		JSAMPROW row = (JSAMPROW)d->pixels->samples + jpeg->output_scanline * nt_pixels_row_bytes(d->pixels);
		jpeg_read_scanlines(jpeg, &row, 1);
	}
	if (all)
		jpeg_finish_decompress(jpeg);
}

static nt_status run(const unsigned char *bytes, size_t size, uint32_t rows, uint32_t least, nt_pixels *pixels,
	nt_error *error)
{
	nt_error failure;
	decoder d = {.session = {.error = error ? error : &failure}, .pixels = pixels};
	*pixels = (nt_pixels){0};
	d.jpeg.err = jpeg_std_error(&d.session.errors);
	d.jpeg.client_data = &d; /* jpeg_create_decompress may fail already, and keeps it */
	d.session.errors.error_exit = leave;
	d.session.errors.emit_message = on_message;
	if (setjmp(d.session.leave)) {
		jpeg_destroy_decompress(&d.jpeg);
		nt_pixels_free(pixels);
		return d.session.error->status;
	}
	decode(&d, bytes, size, rows, least);
	jpeg_destroy_decompress(&d.jpeg);
	return NT_OK;
}

nt_status nt_decode_jpeg(const unsigned char *bytes, size_t size, uint32_t rows, nt_pixels *pixels, nt_error *error)
{
	return run(bytes, size, rows, UINT32_MAX, pixels, error);
}

nt_status nt_decode_jpeg_small(const unsigned char *bytes, size_t size, uint32_t least, nt_pixels *pixels,
	nt_error *error)
{
	return run(bytes, size, UINT32_MAX, least, pixels, error);
}

static void encode(struct jpeg_compress_struct *jpeg, const nt_pixels *pixels, int quality)
{
	jpeg->image_width = pixels->width;
	jpeg->image_height = pixels->height;
	jpeg->input_components = (int)pixels->channels;
	jpeg->in_color_space = pixels->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
	jpeg_set_defaults(jpeg);
	jpeg_set_quality(jpeg, quality, TRUE);
	jpeg->dct_method = JDCT_ISLOW;
	jpeg_start_compress(jpeg, TRUE);
	while (jpeg->next_scanline < pixels->height) {
		JSAMPROW row = (JSAMPROW)pixels->samples + jpeg->next_scanline * nt_pixels_row_bytes(pixels);
		jpeg_write_scanlines(jpeg, &row, 1);
	}
	jpeg_finish_compress(jpeg);
}

nt_status nt_encode_jpeg(const nt_pixels *pixels, int quality, unsigned char **bytes, size_t *size, nt_error *error)
{
	/* twice what the worst blocks take, in whole ones of 16 x 16: the library never has to ask for more */
	unsigned long room = 2048 + 6 * ((unsigned long)pixels->width + 15) * ((unsigned long)pixels->height + 15);
	struct jpeg_compress_struct jpeg = {0};
	session s = {.error = error};
	*size = 0;
	*bytes = nt_alloc(room, 1);
	if (!*bytes)
		return nt_fail_memory(error);
	unsigned char *to = *bytes;
	jpeg.err = jpeg_std_error(&s.errors);
	jpeg.client_data = &s;
	s.errors.error_exit = leave;
	if (setjmp(s.leave)) {
		jpeg_destroy_compress(&jpeg);
		free(*bytes);
		*bytes = NULL;
		return error->status;
	}
	jpeg_create_compress(&jpeg);
	jpeg_mem_dest(&jpeg, &to, &room);
	encode(&jpeg, pixels, quality);
	jpeg_destroy_compress(&jpeg);
	*size = room;
	return NT_OK;
}
