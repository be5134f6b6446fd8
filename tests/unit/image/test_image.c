/* SPDX-License-Identifier: MIT */
/*
 * Decoding. The files are made here, byte by byte after each format's specification, by libjpeg and libtiff as other
 * programs would, and (PNG) by Python's zlib; all show the picture of sample(). Then they are damaged.
 */
#include "image/image.h"

#include <stdio.h> /* for jpeglib.h */
#include <jpeglib.h>
#include <tiffio.h>
#include <unistd.h>
#include <webp/encode.h>
#include "fail_alloc.h"
#include "folder.h"
#include "mutate.h"
#include "test.h"

enum { WIDTH = 5, HEIGHT = 3, ROOM = 1 << 16 };

static unsigned sample(unsigned x, unsigned y, unsigned channel)
{
	return (40 * x + 70 * y + 25 * channel) & 255;
}

typedef struct bytes {
	unsigned char data[ROOM];
	size_t size;
} bytes;

static void put(bytes *b, uint64_t value, unsigned count, bool big)
{
	for (unsigned i = 0; i < count; i++) {
		const unsigned byte = big ? count - 1 - i : i;
		b->data[b->size++] = byte < sizeof value ? (unsigned char)(value >> 8 * byte) : 0;
	}
}

/* ---- files ---- */

typedef struct file_kind file_kind;

struct file_kind {
	const char *name;
	void (*make)(const file_kind *kind, bytes *b);
	nt_image_type type;
	unsigned channels, bits, variant;
	bool flat; /* all 100 */
};

static void tga_header(bytes *b, unsigned type, unsigned width, unsigned height, unsigned depth, unsigned descriptor)
{
	*b = (bytes){.size = 0};
	put(b, type << 16, 12, false);
	put(b, width, 2, false);
	put(b, height, 2, false);
	put(b, depth, 1, false);
	put(b, descriptor, 1, false);
}

static void put_bgr(bytes *b, unsigned y)
{
	for (unsigned x = 0; x < WIDTH; x++)
		for (unsigned channel = 3; channel-- > 0;)
			put(b, sample(x, y, channel), 1, false);
}

/* In packets those of type 10, and from the bottom, which is a TGA's own way. */
static void make_tga(const file_kind *kind, bytes *b)
{
	const bool packed = kind->variant == 10;
	tga_header(b, kind->variant, WIDTH, HEIGHT, 24, packed ? 0 : 0x20);
	for (unsigned row = 0; row < HEIGHT; row++) {
		if (packed)
			put(b, WIDTH - 1, 1, false);
		put_bgr(b, packed ? HEIGHT - 1 - row : row);
	}
}

static void bmp_header(bytes *b, unsigned width, unsigned height, unsigned depth, unsigned colors, unsigned size)
{
	*b = (bytes){.size = 0};
	put(b, 'B' | 'M' << 8, 2, false);
	put(b, 54 + 4 * colors + size, 4, false);
	put(b, 0, 4, false);
	put(b, 54 + 4 * colors, 4, false);
	put(b, 40, 4, false);
	put(b, width, 4, false);
	put(b, height, 4, false);
	put(b, 1, 2, false);
	put(b, depth, 2, false);
	put(b, 0, 24, false);
}

static void make_bmp(const file_kind *kind, bytes *b)
{
	const unsigned row = (3 * WIDTH + 3) / 4 * 4;
	bmp_header(b, WIDTH, HEIGHT, 8 * kind->channels, 0, row * HEIGHT);
	for (unsigned y = HEIGHT; y-- > 0;) {
		put_bgr(b, y);
		put(b, 0, row - 3 * WIDTH, false);
	}
}

static void make_psd(const file_kind *kind, bytes *b)
{
	*b = (bytes){.size = 0};
	put(b, '8' << 24 | 'B' << 16 | 'P' << 8 | 'S', 4, true);
	put(b, 1, 2, true);
	put(b, 0, 6, true);
	put(b, 3, 2, true);
	put(b, HEIGHT, 4, true);
	put(b, WIDTH, 4, true);
	put(b, kind->bits, 2, true);
	put(b, 3, 2, true); /* RGB */
	put(b, 0, 4, true);
	put(b, kind->variant, 4, true); /* bytes of resources */
	put(b, 0, kind->variant, true);
	put(b, 0, 4, true);
	put(b, 0, 2, true); /* not packed */
	for (unsigned channel = 0; channel < 3; channel++)
		for (unsigned y = 0; y < HEIGHT; y++)
			for (unsigned x = 0; x < WIDTH; x++)
				put(b, sample(x, y, channel) * (kind->bits == 16 ? 257 : 1), kind->bits / 8, true);
}

/* libtiff's own writer, to a file; the variant is the compression. */
static void make_tiff(const file_kind *kind, bytes *b)
{
	const unsigned channels = kind->channels, bits = kind->bits;
	const bool tiled = kind->variant == COMPRESSION_PACKBITS;
	const char *path = in_folder("made.tif");
	TIFF *tiff = TIFFOpen(path, "w");
	TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, WIDTH);
	TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, HEIGHT);
	TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels);
	TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
	TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
	TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
	TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind->variant);
	unsigned char rows[16 * 16 * 8] = {0};
	const size_t row = (tiled ? 16 : WIDTH) * channels * bits / 8;
	for (unsigned y = 0; y < HEIGHT; y++)
		for (unsigned i = 0; i < WIDTH * channels; i++)
			for (unsigned k = 0; k < bits / 8; k++) /* both bytes alike, as 257 times the sample */
				rows[y * row + i * bits / 8 + k] = (unsigned char)sample(i / channels, y, i % channels);
	if (tiled) {
		TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
		TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
		assert_true(TIFFWriteTile(tiff, rows, 0, 0, 0, 0) > 0);
	}
	for (unsigned y = 0; y < HEIGHT && !tiled; y++)
		assert_int_equal(TIFFWriteScanline(tiff, rows + y * row, y, 0), 1);
	TIFFClose(tiff);
	FILE *file = fopen(path, "rb");
	b->size = fread(b->data, 1, ROOM, file);
	fclose(file);
}

/* 16 x 16 of one grey, which a JPEG has exactly. */
static void make_jpeg(const file_kind *kind, bytes *b)
{
	struct jpeg_compress_struct jpeg;
	struct jpeg_error_mgr errors;
	unsigned char *made = NULL, row[16 * 3];
	unsigned long size = 0;
	jpeg.err = jpeg_std_error(&errors);
	jpeg_create_compress(&jpeg);
	jpeg_mem_dest(&jpeg, &made, &size);
	jpeg.image_width = jpeg.image_height = 16;
	jpeg.input_components = (int)kind->channels;
	jpeg.in_color_space = kind->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
	jpeg_set_defaults(&jpeg);
	jpeg_simple_progression(&jpeg);
	jpeg_start_compress(&jpeg, TRUE);
	memset(row, 100, sizeof row);
	for (unsigned y = 0; y < 16; y++)
		jpeg_write_scanlines(&jpeg, (JSAMPROW[]){row}, 1);
	jpeg_finish_compress(&jpeg);
	jpeg_destroy_compress(&jpeg);
	memcpy(b->data, made, size);
	b->size = size;
	free(made);
}

static void make_png(const file_kind *kind, bytes *b)
{
	nt_pixels pixels;
	nt_error error;
	unsigned char *made;
	make_tga(kind, b);
	assert_int_equal(nt_image_decode(b->data, b->size, &pixels, &error), NT_OK);
	assert_int_equal(nt_encode_png(&pixels, &made, &b->size, &error), NT_OK);
	memcpy(b->data, made, b->size);
	nt_pixels_free(&pixels);
	free(made);
}

/* libwebp's own writer, without loss; the variant has 1 for with. */
static void make_webp(const file_kind *kind, bytes *b)
{
	const int channels = (int)kind->channels, width = kind->flat ? 16 : WIDTH, height = kind->flat ? 16 : HEIGHT;
	unsigned char pixels[16 * 16 * 4], *made;
	for (int i = 0; i < width * height * channels; i++) {
		const unsigned x = (unsigned)(i / channels % width), y = (unsigned)(i / channels / width);
		pixels[i] = (unsigned char)(kind->flat ? 100 : sample(x, y, (unsigned)(i % channels)));
	}
	b->size = kind->variant ? WebPEncodeRGB(pixels, width, height, 3 * width, 100, &made)
		: channels == 4 ? WebPEncodeLosslessRGBA(pixels, width, height, 4 * width, &made)
				: WebPEncodeLosslessRGB(pixels, width, height, 3 * width, &made);
	assert_true(b->size > 0 && b->size <= ROOM);
	memcpy(b->data, made, b->size);
	WebPFree(made);
}

static const file_kind files[] = {
	{"png", make_png, NT_IMAGE_PNG, 3, 8, 2, false},
	{"tga", make_tga, NT_IMAGE_TGA, 3, 8, 2, false},
	{"packed tga", make_tga, NT_IMAGE_TGA, 3, 8, 10, false},
	{"bmp", make_bmp, NT_IMAGE_BMP, 3, 8, 0, false},
	{"psd", make_psd, NT_IMAGE_PSD, 3, 8, 0, false},
	{"psd of 16 bits", make_psd, NT_IMAGE_PSD, 3, 16, 300, false},
	{"tiff", make_tiff, NT_IMAGE_TIFF, 3, 8, COMPRESSION_LZW, false},
	{"tiff of 16 bits", make_tiff, NT_IMAGE_TIFF, 1, 16, COMPRESSION_ADOBE_DEFLATE, false},
	{"tiff of alpha and 16 bits", make_tiff, NT_IMAGE_TIFF, 4, 16, COMPRESSION_LZW, false},
	{"tiled tiff", make_tiff, NT_IMAGE_TIFF, 3, 8, COMPRESSION_PACKBITS, false},
	{"grey jpeg", make_jpeg, NT_IMAGE_JPEG, 1, 8, 0, true},
	{"jpeg", make_jpeg, NT_IMAGE_JPEG, 3, 8, 0, true},
	{"webp", make_webp, NT_IMAGE_WEBP, 3, 8, 0, false},
	{"webp with alpha", make_webp, NT_IMAGE_WEBP, 4, 8, 0, false},
	{"webp with loss", make_webp, NT_IMAGE_WEBP, 3, 8, 1, true},
};
enum { FILE_COUNT = sizeof files / sizeof files[0] };

/* ---- tests ---- */

static unsigned sample_at(const nt_pixels *p, unsigned x, unsigned y, unsigned channel)
{
	const size_t i = ((size_t)y * p->width + x) * p->channels + channel;
	return p->bits == 8 ? ((uint8_t *)p->samples)[i] : ((uint16_t *)p->samples)[i];
}

/* NT_SEEDS=FOLDER: there, for tests/fuzz/seeds.sh. */
static void store_seed(const char *name, const bytes *b)
{
	char path[400];
	if (!getenv("NT_SEEDS"))
		return;
	snprintf(path, sizeof path, "%s/%s", getenv("NT_SEEDS"), name);
	FILE *stream = fopen(path, "wb");
	assert_non_null(stream);
	assert_int_equal(fwrite(b->data, 1, b->size, stream), b->size);
	assert_int_equal(fclose(stream), 0);
}

TEST(decode_gives_the_picture)
{
	for (size_t i = 0; i < FILE_COUNT; i++) {
		bytes b;
		nt_pixels p;
		nt_error error;
		files[i].make(&files[i], &b);
		assert_int_equal(nt_image_type_of_bytes(b.data, b.size), files[i].type);
		assert_true(nt_image_is_decoded(files[i].type));
		store_seed(files[i].name, &b);
		if (nt_image_decode(b.data, b.size, &p, &error))
			fail_msg("%s: %s", files[i].name, error.message);
		assert_int_equal(p.channels, files[i].channels);
		assert_int_equal(p.bits, files[i].bits);
		assert_int_equal(p.width, files[i].flat ? 16 : WIDTH);
		assert_int_equal(p.height, files[i].flat ? 16 : HEIGHT);
		for (unsigned y = 0; y < p.height; y++)
			for (unsigned x = 0; x < p.width; x++)
				for (unsigned c = 0; c < p.channels; c++)
					assert_int_equal(sample_at(&p, x, y, c),
						files[i].flat ? 100 : sample(x, y, c) * (p.bits == 16 ? 257 : 1));
		nt_pixels_free(&p);
	}
}

/* Python: zlib.compress() of the rows with filter 0. */
static const unsigned char png_palette[] = {
	0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
	0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x02, 0x03, 0x00, 0x00, 0x00, 0x0f, 0xd8, 0xe5,
	0xb7, 0x00, 0x00, 0x00, 0x09, 0x50, 0x4c, 0x54, 0x45, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07,
	0x08, 0x09, 0x25, 0x85, 0x56, 0xf0, 0x00, 0x00, 0x00, 0x02, 0x74, 0x52, 0x4e, 0x53, 0xff, 0x80,
	0x08, 0x0f, 0xb3, 0x6a, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x70,
	0x60, 0x68, 0x00, 0x00, 0x01, 0x44, 0x00, 0xc1, 0x3a, 0x7a, 0x1c, 0x56, 0x00, 0x00, 0x00, 0x00,
	0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
};

TEST(decode_png_of_a_palette)
{
	nt_pixels p;
	nt_error error;
	/* indices 1 0 / 2 0; entry 1 has alpha 0x80 */
	static const uint8_t expected[] = {4, 5, 6, 0x80, 1, 2, 3, 0xff, 7, 8, 9, 0xff, 1, 2, 3, 0xff};
	assert_int_equal(nt_image_decode(png_palette, sizeof png_palette, &p, &error), NT_OK);
	assert_int_equal(p.channels, 4);
	assert_memory_equal(p.samples, expected, sizeof expected);
	nt_pixels_free(&p);
}

TEST(encode_keeps_every_kind_of_sample)
{
	for (unsigned channels = 1; channels <= 4; channels++)
		for (unsigned bits = 8; bits <= 16; bits += 8) {
			nt_pixels p, back;
			nt_error error;
			unsigned char *png, *again;
			size_t size, again_size;
			assert_int_equal(nt_pixels_create(&p, 7, 9, channels, bits, &error), NT_OK);
			for (size_t i = 0; i < nt_pixels_row_bytes(&p) * p.height; i++)
				((uint8_t *)p.samples)[i] = (uint8_t)(i * i + 3 * i);
			assert_int_equal(nt_encode_png(&p, &png, &size, &error), NT_OK);
			assert_int_equal(nt_encode_png(&p, &again, &again_size, &error), NT_OK);
			assert_int_equal(size, again_size);
			assert_memory_equal(png, again, size);
			assert_int_equal(nt_image_decode(png, size, &back, &error), NT_OK);
			assert_int_equal(back.channels, channels);
			assert_int_equal(back.bits, bits);
			assert_memory_equal(back.samples, p.samples, nt_pixels_row_bytes(&p) * p.height);
			nt_pixels_free(&p);
			nt_pixels_free(&back);
			free(png);
			free(again);
		}
}

static __attribute__((noinline)) void leave_on_the_stack(int value)
{
	char frame[1 << 14];
	memset(frame, value, sizeof frame);
	__asm__ volatile("" : : "r"(frame) : "memory");
}

/* stb_image looks for such a colour behind those that it has read. */
TEST(colours_that_a_palette_lacks_are_the_same_in_every_run)
{
	bytes b;
	bmp_header(&b, 4, 1, 8, 2, 4);
	put(&b, 0x112233, 4, false); /* two colours */
	put(&b, 0x445566, 4, false);
	put(&b, 0xc8030100, 4, false); /* 0, 1, 3, 200 */
	static const unsigned char expected[12] = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66};
	for (int value = 0; value < 3; value++) {
		nt_pixels p;
		nt_error error;
		leave_on_the_stack(100 * value);
		assert_int_equal(nt_image_decode(b.data, b.size, &p, &error), NT_OK);
		assert_memory_equal(p.samples, expected, sizeof expected);
		nt_pixels_free(&p);
	}
}

/* One pixel of a grey column is another one; six levels are grey. */
TEST(grey_is_told_by_pixels)
{
	static const struct {
		unsigned rgb[3], row;
		bool grey;
	} rows[] = {{{100, 106, 103}, 0, true}, {{100, 107, 103}, 0, false}, {{103, 100, 107}, 0, false},
		{{100, 103, 107}, 0, false}, {{106, 100, 103}, 11, true}, {{107, 100, 103}, 11, false}};
	for (size_t i = 0; i < 2 * sizeof rows / sizeof *rows; i++) {
		enum { ROWS = 12 };
		const unsigned bits = i % 2 ? 16 : 8;
		const size_t at = 3 * rows[i / 2].row;
		nt_pixels p;
		nt_error error;
		unsigned char *png;
		size_t size;
		bool grey;
		assert_int_equal(nt_pixels_create(&p, 1, ROWS, 3, bits, &error), NT_OK);
		memset(p.samples, 99, nt_pixels_row_bytes(&p) * ROWS);
		for (size_t c = 0; c < 3; c++)
			if (bits == 8)
				((uint8_t *)p.samples)[at + c] = (uint8_t)rows[i / 2].rgb[c];
			else
				((uint16_t *)p.samples)[at + c] = (uint16_t)(257 * rows[i / 2].rgb[c]);
		assert_int_equal(nt_pixels_are_grey(&p, 6), rows[i / 2].grey);
		assert_int_equal(nt_encode_png(&p, &png, &size, &error), NT_OK);
		assert_int_equal(nt_image_is_grey(png, size, &grey, &error), NT_OK);
		assert_int_equal(grey, rows[i / 2].grey);
		nt_pixels_free(&p);
		free(png);
	}
}

/* A file without any part of it is no image. Parts that may be missing: of a PNG the checksum of the last
 * IDAT and the IEND, which has 12 bytes, the padding of a BMP's last row, and a TIFF's offset of a second image. */
TEST(decode_refuses_what_is_cut_short)
{
	for (size_t i = 0; i < FILE_COUNT; i++) {
		bytes b;
		nt_error error;
		nt_pixels p;
		files[i].make(&files[i], &b);
		const size_t idle = files[i].type == NT_IMAGE_PNG ? 17
			: files[i].type == NT_IMAGE_BMP || files[i].type == NT_IMAGE_TIFF ? 5 : 1;
		for (size_t size = 0; size < b.size; size++) {
			unsigned char *exact = malloc(size + !size); /* so that a sanitizer sees who reads beyond */
			memcpy(exact, b.data, size);
			const nt_status status = nt_image_decode(exact, size, &p, &error);
			if (size + idle <= b.size && status == NT_OK)
				fail_msg("%s: %zu of %zu bytes are decoded", files[i].name, size, b.size);
			if (status)
				assert_null(p.samples);
			nt_pixels_free(&p);
			free(exact);
		}
	}
}

/* Behind the end stb_image would read packets of no pixels, or lines of the header, for ever. */
TEST(decode_ends_where_an_hdr_ends)
{
	static const char row[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n" "\2\2\0\10\210a";
	static const char header[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n-Y 2 +X 8\n";
	nt_pixels p;
	nt_error error;
	alarm(60);
	assert_int_equal(nt_image_decode((const unsigned char *)row, sizeof row - 1, &p, &error), NT_ERROR_INPUT);
	assert_int_equal(nt_image_decode((const unsigned char *)header, sizeof header - 1, &p, &error), NT_ERROR_INPUT);
	alarm(0);
}

TEST(decode_refuses_sizes_before_it_asks_for_memory)
{
	static const unsigned sides[] = {65535, 32768, 20000, 16384};
	for (size_t i = 0; i < 4; i++) {
		bytes b;
		nt_pixels p;
		nt_error error;
		tga_header(&b, 2, sides[i], sides[i], 24, 0x20);
		b.size += 200;
		/* nothing of ours is asked for either; the libraries' blocks are small */
		fail_allocations_from(0);
		const nt_status status = nt_image_decode(b.data, b.size, &p, &error);
		assert_false(stop_failing_allocations());
		assert_int_equal(status, sides[i] > 16384 ? NT_ERROR_UNSUPPORTED : NT_ERROR_INPUT);

	}
	/* the head of a PNG of 42 x 5963792 pixels */
	static const unsigned char png[] =
		"\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\0\052\0\133\0\020\010\002\0\0\0\347\014\225\127"
					   "\0\0\002lIDATx`";
	nt_pixels p;
	nt_error error;
	assert_int_equal(nt_image_decode(png, sizeof png, &p, &error), NT_ERROR_INPUT);
	assert_string_equal(error.message, "PNG: 44 bytes cannot hold 42 x 5963792 pixels");
	/* a TIFF of 18 761 channels of 16 bits, which libtiff would make room for: 769 MB */
	static const uint16_t tags[][6] = {{256, 3, 1, 0, 5}, {257, 3, 1, 0, 4099}, {258, 3, 1, 0, 16},
		{259, 3, 1, 0, 8}, {262, 3, 1, 0, 1}, {273, 4, 1, 0, 8}, {277, 3, 1, 0, 18761}, {279, 4, 1, 0, 39}};
	unsigned char tiff[10 + sizeof tags + 4] = "II*\0\010\0\0\0\010";
	memcpy(tiff + 10, tags, sizeof tags);
	assert_int_equal(nt_image_decode(tiff, sizeof tiff, &p, &error), NT_ERROR_INPUT);
	assert_string_equal(error.message, "TIFF: 110 bytes cannot hold 5 x 4099 pixels");
}

TEST(samples_that_are_floats_are_refused)
{
	const char *path = in_folder("float.tif");
	TIFF *tiff = TIFFOpen(path, "w");
	const float row[2] = {0.5f, 1};
	TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2);
	TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
	TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
	TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
	TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
	assert_int_equal(TIFFWriteScanline(tiff, (void *)(uintptr_t)row, 0, 0), 1);
	TIFFClose(tiff);
	bytes b;
	nt_pixels p;
	nt_error error;
	FILE *file = fopen(path, "rb");
	b.size = fread(b.data, 1, ROOM, file);
	fclose(file);
	assert_int_equal(nt_image_decode(b.data, b.size, &p, &error), NT_ERROR_UNSUPPORTED);
	assert_string_equal(error.message, "TIFF: samples that are no unsigned integers");
}

/* As --help says it: 256 pixels for each byte, and 2^34 of small files; of one image 64 times as many for each byte. */
TEST(pixels_are_held_against_bytes)
{
	static const struct {
		uint64_t pixels, most, bytes;
		bool one, all;
	} rows[] = {{16384 * 9 + 16383, 0, 9, true, true}, {16384 * 10, 0, 9, false, true},
		{16384 * 10, 16384 * 10, 9, true, true},
		{UINT64_C(1) << 34, 0, 1 << 26, true, true}, {(UINT64_C(1) << 34) + 1, 0, 1 << 26, true, false},
		{(UINT64_C(1) << 34) + 256, 0, (1 << 26) + 1, true, true},
		{(UINT64_C(1) << 34) + 257, 0, (1 << 26) + 1, true, false}, {101, 100, 1 << 20, true, false}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_error error;
		assert_int_equal(nt_check_image(rows[i].pixels, rows[i].most, rows[i].bytes, NULL, &error),
			rows[i].one ? NT_OK : NT_ERROR_LIMIT);
		assert_int_equal(nt_check_pixels(rows[i].pixels, rows[i].most, rows[i].bytes, &error),
			rows[i].all ? NT_OK : NT_ERROR_LIMIT);
	}
}

/* A JPEG of SIDE x SIDE black pixels whose scan has the blocks' first coefficients alone, or all; malloc'ed. */
enum { SIDE = 2048 };

static unsigned char *make_dense_jpeg(int components, bool wide_and_high, bool arithmetic, bool sequential,
	unsigned long *size)
{
	const jpeg_scan_info first_coefficients = {.comps_in_scan = components, .component_index = {0, 1, 2}};
	struct jpeg_compress_struct jpeg;
	struct jpeg_error_mgr errors;
	unsigned char *made = NULL, row[3 * SIDE] = {0};
	*size = 0;
	jpeg.err = jpeg_std_error(&errors);
	jpeg_create_compress(&jpeg);
	jpeg_mem_dest(&jpeg, &made, size);
	jpeg.image_width = jpeg.image_height = SIDE;
	jpeg.input_components = components;
	jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : JCS_RGB;
	jpeg_set_defaults(&jpeg);
	if (wide_and_high) {
		jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[1].v_samp_factor = 4;
		jpeg.comp_info[0].v_samp_factor = jpeg.comp_info[1].h_samp_factor = 1;
	}
	if (!sequential) {
		jpeg.scan_info = &first_coefficients;
		jpeg.num_scans = 1;
	}
	jpeg.arith_code = arithmetic;
	jpeg.optimize_coding = !arithmetic;
	jpeg_start_compress(&jpeg, TRUE);
	for (unsigned y = 0; y < SIDE; y++)
		jpeg_write_scanlines(&jpeg, (JSAMPROW[]){row}, 1);
	jpeg_finish_compress(&jpeg);
	jpeg_destroy_compress(&jpeg);
	return made;
}

/* Its frame (SOF2, SOF9 or SOF10): the marker, length and precision, then height and width. */
static void declare(unsigned char *jpeg, size_t size, unsigned width, unsigned height)
{
	unsigned char *frame = memmem(jpeg, size, "\xff\xc2", 2);
	frame = frame ? frame : memmem(jpeg, size, "\xff\xca", 2);
	frame = frame ? frame : memmem(jpeg, size, "\xff\xc9", 2);
	memcpy(frame + 5, (unsigned char[]){height >> 8 & 255, height & 255, width >> 8 & 255, width & 255}, 4);
}

static void decodes_with(const unsigned char *jpeg, size_t size, nt_status expected, const char *message)
{
	nt_pixels p;
	nt_error error;
	const nt_status status = nt_image_decode(jpeg, size, &p, &error);
	assert_int_equal(status, expected);
	if (status)
		assert_non_null(strstr(error.message, message));
	else
		nt_pixels_free(&p);
}

/* The densest JPEG by Huffman codes: one grey, a bit each. */
TEST(jpegs_are_held_against_a_bit_for_each_block)
{
	unsigned long size;
	unsigned char *made = make_dense_jpeg(1, false, false, false, &size);
	assert_true(size < SIDE * SIDE / 512 + 200);
	decodes_with(made, size, NT_OK, NULL);
	declare(made, size, SIDE, 2 * SIDE + 1); /* more than twice as high */
	decodes_with(made, size, NT_ERROR_INPUT, " bytes cannot hold 2048 x 4097 pixels");
	free(made);
}

/* With components of 4 x 1, 1 x 4 and 1 x 1 no component has a block for each 8 x 8 pixels: of 16 all have 9. */
TEST(blocks_of_a_jpeg_may_cover_many_pixels)
{
	unsigned long size;
	unsigned char *made = make_dense_jpeg(3, true, false, false, &size);
	assert_in_range(size, SIDE * SIDE / 512 * 9 / 16, SIDE * SIDE / 512 * 10 / 16 + 200);
	decodes_with(made, size, NT_OK, NULL);
	free(made);
}

/* Arithmetic codes take next to nothing where nothing changes. libjpeg's memory for all scans follows the declared
 * size: that is looked at first, even if some rows are enough. */
TEST(jpegs_of_arithmetic_codes_have_a_bound)
{
	unsigned long size;
	unsigned char *made = make_dense_jpeg(3, false, true, false, &size);
	assert_true(size < SIDE);
	decodes_with(made, size, NT_OK, NULL);
	declare(made, size, 8192, 8192);
	decodes_with(made, size, NT_ERROR_INPUT, " bytes cannot hold 8192 x 8192 pixels");
	/* Seven megabytes behind the image, so that these are enough. */
	const size_t padded = size + 7 * (1 << 20);
	made = realloc(made, padded);
	memset(made + size, 0, padded - size);
	declare(made, size, 17000, 16384);
	nt_pixels p;
	nt_error error;
	assert_int_equal(nt_decode_jpeg(made, padded, 1, &p, &error), NT_ERROR_UNSUPPORTED);
	assert_non_null(strstr(error.message, "17000 x 16384 pixels of 3 bytes, more than nmtan decodes"));
	free(made);
}

/* Images of one colour are as small as they like. Nothing is kept of a single scan. */
TEST(large_jpegs_of_arithmetic_codes_are_decoded)
{
	static const unsigned sides[] = {6000, 16384}; /* of several scans, of one */
	for (int sequential = 0; sequential < 2; sequential++) {
		unsigned long size;
		nt_pixels p;
		nt_error error;
		unsigned char *made = make_dense_jpeg(3, false, true, sequential, &size);
		assert_true(size < 1000);
		declare(made, size, sides[sequential], sides[sequential]);
		if (nt_decode_jpeg(made, size, 8, &p, &error))
			fail_msg("%s", error.message);
		assert_int_equal(p.width, sides[sequential]);
		assert_int_equal(p.height, 8);
		nt_pixels_free(&p);
		free(made);
	}
}

/* Any bytes: an image or an error, and never more. The build with sanitizers looks on. */
TEST(decode_survives_damage)
{
	uint32_t seed = 13;
	for (size_t i = 0; i < FILE_COUNT; i++) {
		bytes b;
		files[i].make(&files[i], &b);
		for (int turn = 0; turn < 400; turn++) {
			nt_pixels p;
			nt_error error;
			char *damaged = malloc(b.size + MUTATE_ROOM);
			memcpy(damaged, b.data, b.size);
			const size_t size = mutate(damaged, b.size, &seed);
			bool grey;
			if (nt_image_decode((unsigned char *)damaged, size, &p, &error) == NT_OK) {
				assert_in_range(p.channels, 1, 4);
				nt_pixels_free(&p);
			}
			nt_image_is_grey((unsigned char *)damaged, size, &grey, &error);
			free(damaged);
		}
	}
}

TEST(decode_without_memory_is_an_error)
{
	for (size_t i = 0; i < FILE_COUNT; i++) {
		bytes b;
		files[i].make(&files[i], &b);
		for (size_t n = 0;; n++) {
			nt_pixels p;
			nt_error error;
			fail_allocations_from(n);
			const nt_status status = nt_image_decode(b.data, b.size, &p, &error);
			if (!stop_failing_allocations()) {
				assert_int_equal(status, NT_OK);
				nt_pixels_free(&p);
				break;
			}
			assert_int_equal(status, NT_ERROR_MEMORY);
			assert_null(p.samples);
		}
		nt_pixels p; /* and what is damaged later is told as that */
		nt_error error;
		assert_int_equal(nt_image_decode(b.data, b.size / 2, &p, &error), NT_ERROR_INPUT);
	}
}

AROUND_ALL(make_folder, remove_folder)
