#!/bin/sh
# SPDX-License-Identifier: MIT
#
# configure.sh SOURCES INCLUDE: the headers in INCLUDE that foreign libraries' own builds would make. They say what the tool
# needs, for a processor of 32 bits; what they say of formats is what Debian's builds say.
set -eu
sources=$1 include=$2
system=/usr/include
mkdir -p "$include/draco"

# Libraries of headers alone.
for header in fast_float nlohmann xxhash.h xxh3.h stb; do
	[ ! -e "$system/$header" ] || ln -sfn "$system/$header" "$include/$header"
done

# Headers that are installed beside the others' headers, without those that read whole scenes or ask for vector code.
installed() { find "$system" -name "$1" | head -n 1; }
grep -v TRANSCODER "$system/draco/draco_features.h" >"$include/draco/draco_features.h"
grep -v WITH_SIMD "$(installed jconfig.h)" >"$include/jconfig.h"
grep -v -E 'JBIG|LERC|JXL' "$(installed tiffconf.h)" | sed 's/int64_t$/int32_t/' >"$include/tiffconf.h"

sed 's/@COPYRIGHT_YEAR@/2023/' "$sources/libjpeg-turbo/unpacked/jversion.h.in" >"$include/jversion.h"
cat >"$include/jconfigint.h" <<'END'
#define BUILD ""
#undef inline
#define INLINE inline
#define THREAD_LOCAL
#define PACKAGE_NAME "libjpeg-turbo"
#define VERSION "2"
#define SIZEOF_SIZE_T 4
#define HAVE_BUILTIN_CTZL 1
#define FALLTHROUGH __attribute__((fallthrough));
END
cat >"$include/tif_config.h" <<'END'
#include <inttypes.h>
#include "tiffconf.h"
#define HAVE_ASSERT_H 1
#define HAVE_FCNTL_H 1
#define HAVE_STRINGS_H 1
#define HAVE_SYS_TYPES_H 1
#define HAVE_UNISTD_H 1
#define HAVE_DECL_OPTARG 1
#define PACKAGE_NAME "libtiff"
#define SIZEOF_SIZE_T 4
#define STRIP_SIZE_DEFAULT 8192
#define TIFF_SSIZE_FORMAT PRId32
#define TIFF_MAX_DIR_COUNT 1048576
#define ZSTD_SUPPORT 1
END

# Linux's own, of which the tool asks for files that share their blocks: the system refuses it.
mkdir -p "$include/linux"
echo '#define FICLONE 0x40049409' >"$include/linux/fs.h"
