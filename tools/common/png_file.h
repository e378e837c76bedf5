/* Pictures as PNG files. */
#ifndef ENFILADE_COMMON_PNG_FILE_H
#define ENFILADE_COMMON_PNG_FILE_H

#include <enfilade/base.h>

/** Writes 8-bit RGBA, rows top to bottom, `width * 4` bytes a row; atomically. `opaque` leaves the alpha channel out. The
 *  bytes depend on the picture alone (no time stamp). */
EnfResult enf_png_write(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height, bool opaque, EnfError *error);

/** Reads any PNG into 8-bit RGBA of enf_default_allocator (free `*rgba` with enf_free(NULL, *rgba, width*height, 4)). */
EnfResult enf_png_read(const char *path, uint8_t **rgba, uint32_t *width, uint32_t *height, EnfError *error);

#endif
