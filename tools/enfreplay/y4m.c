/* Pictures into YUV4MPEG2, a plane after another, no colour averaged away (4:4:4). Integers only: the same file everywhere. */
#include "enfreplay/y4m.h"

#include <stdio.h>
#include <string.h>

static EnfResult put(Y4m *video, const void *data, size_t size, EnfError *error) {
    if (video->stream) {
        return enf_stream_write(video->stream, data, size, error);
    }
    if (fwrite(data, 1, size, stdout) != size || fflush(stdout) != 0) {
        return enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "cannot write to stdout");
    }
    return ENF_OK;
}

EnfResult y4m_open(Y4m *video, const char *path, const uint32_t size_px[2], uint32_t rate, uint32_t per, EnfError *error) {
    memset(video, 0, sizeof *video);
    video->width = size_px[0];
    video->height = size_px[1];
    video->path = path;
    video->planes = enf_alloc(NULL, (size_t)video->width * video->height, 3);
    if (!video->planes) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a picture");
    }
    EnfResult result = strcmp(path, "-") == 0 ? ENF_OK : enf_stream_create(&video->stream, path, NULL, error);
    char header[128];
    int length = snprintf(header, sizeof header, "YUV4MPEG2 W%u H%u F%u:%u Ip A1:1 C444\n", video->width, video->height, rate,
                          per);
    return result == ENF_OK ? put(video, header, (size_t)length, error) : result;
}

void y4m_convert(const uint8_t rgb[3], uint8_t ycc[3]) {
    int r = rgb[0], g = rgb[1], b = rgb[2];
    /* The usual fixed-point form of the matrix, 8 fractional bits; sums stay positive before the shift. */
    ycc[0] = (uint8_t)((66 * r + 129 * g + 25 * b + 128 + (16 << 8)) >> 8);
    ycc[1] = (uint8_t)((-38 * r - 74 * g + 112 * b + 128 + (128 << 8)) >> 8);
    ycc[2] = (uint8_t)((112 * r - 94 * g - 18 * b + 128 + (128 << 8)) >> 8);
}

EnfResult y4m_write(Y4m *video, const uint8_t *rgba, EnfError *error) {
    size_t count = (size_t)video->width * video->height;
    for (size_t i = 0; i < count; i++) {
        uint8_t ycc[3];
        y4m_convert(rgba + 4 * i, ycc);
        video->planes[i] = ycc[0];
        video->planes[count + i] = ycc[1];
        video->planes[2 * count + i] = ycc[2];
    }
    EnfResult result = put(video, "FRAME\n", 6, error);
    return result == ENF_OK ? put(video, video->planes, 3 * count, error) : result;
}

EnfResult y4m_finish(Y4m *video, EnfError *error) {
    return video->stream ? enf_stream_finish(video->stream, error) : ENF_OK;
}

void y4m_close(Y4m *video) {
    enf_stream_destroy(video->stream, false);
    enf_free(NULL, video->planes, (size_t)video->width * video->height, 3);
    memset(video, 0, sizeof *video);
}
