/* Video as YUV4MPEG2: uncompressed pictures that every player and encoder reads. */
#ifndef ENFREPLAY_Y4M_H
#define ENFREPLAY_Y4M_H

#include <enfilade/base.h>

typedef struct Y4m {
    EnfStream *stream; /**< NULL: stdout */
    uint32_t width, height;
    uint8_t *planes; /**< of one picture */
    const char *path;
} Y4m;

/** Begins a video of `rate`/`per` pictures a second; `path` "-" is stdout. Written beside its place until y4m_finish. */
EnfResult y4m_open(Y4m *video, const char *path, const uint32_t size_px[2], uint32_t rate, uint32_t per, EnfError *error);
/** Adds a picture: 8-bit RGBA, rows top to bottom. */
EnfResult y4m_write(Y4m *video, const uint8_t *rgba, EnfError *error);
EnfResult y4m_finish(Y4m *video, EnfError *error);
/** Frees; a video that was not finished is removed. Zeroed is fine. */
void y4m_close(Y4m *video);

/** Y, Cb, Cr of a colour: ITU-R BT.601, 16..235 and 16..240. */
void y4m_convert(const uint8_t rgb[3], uint8_t ycc[3]);

#endif
