/* A look at a JPEG's segments before stb_image sees them. Its reader up to 2.27 (2021, the one that Debian 12 has) writes behind its
 * tables when a Huffman table lists more than 256 codes; everything else that it got wrong is harmless in zeroed memory (image.c). */
#include "compile/import.h"

enum {
    MARKER_SOI = 0xD8,
    MARKER_EOI = 0xD9,
    MARKER_SOS = 0xDA,
    MARKER_DHT = 0xC4,
    MARKER_RST_FIRST = 0xD0,
    MARKER_RST_LAST = 0xD7
};

/* The next marker; 0 at the end of the data. In entropy-coded data FF 00 and restart markers are no end (ITU T.81, B.1.1). */
static uint8_t next_marker(EnfCursor *cursor, bool coded) {
    while (cursor->offset < cursor->size) {
        if (enf_cursor_u8(cursor) != 0xFF) {
            continue;
        }
        uint8_t marker = 0xFF;
        while (marker == 0xFF && cursor->offset < cursor->size) {
            marker = enf_cursor_u8(cursor);
        }
        bool data = marker == 0 || (coded && marker >= MARKER_RST_FIRST && marker <= MARKER_RST_LAST);
        if (!data && marker != 0xFF) {
            return marker;
        }
    }
    return 0;
}

/* A segment of Huffman tables: each lists how many codes it has of every length, then their symbols (B.2.4.2). */
static bool tables_are_safe(const uint8_t *data, size_t size) {
    EnfCursor cursor = enf_cursor(data, size);
    while (cursor.offset < size) {
        enf_cursor_u8(&cursor); /* class and number */
        uint32_t codes = 0;
        for (int length = 1; length <= 16; length++) {
            codes += enf_cursor_u8(&cursor);
        }
        if (codes > 256 || (codes && !enf_cursor_bytes(&cursor, codes)) || cursor.failed) {
            return false;
        }
    }
    return true;
}

bool enf_jpeg_is_safe(EnfImportBytes bytes) {
    EnfCursor cursor = enf_cursor(bytes.data, bytes.size);
    bool coded = false;
    for (uint8_t marker = next_marker(&cursor, coded); marker && marker != MARKER_EOI; marker = next_marker(&cursor, coded)) {
        if (marker == MARKER_SOI) {
            continue;
        }
        uint32_t high = enf_cursor_u8(&cursor);
        uint32_t length = high << 8 | enf_cursor_u8(&cursor);
        size_t left = bytes.size - cursor.offset;
        if (cursor.failed || length < 2 || length - 2 > left) {
            return marker != MARKER_DHT; /* the decoder ends here, too, but it would read such tables first */
        }
        if (marker == MARKER_DHT && !tables_are_safe(bytes.data + cursor.offset, length - 2)) {
            return false;
        }
        cursor.offset += length - 2;
        coded = marker == MARKER_SOS;
    }
    return true;
}
