/* The sticky reader: a parser reads on without looking, and asks once at the end whether all of it was there. */
#include <enfilade/base.h>

#include <string.h>

EnfCursor enf_cursor(const void *data, size_t size) {
    EnfCursor cursor = {data, size, 0, false};
    return cursor;
}

const uint8_t *enf_cursor_bytes(EnfCursor *cursor, size_t size) {
    if (cursor->failed || size > cursor->size - cursor->offset) {
        cursor->failed = true;
        return NULL;
    }
    /* Zero bytes of a NULL block are no failure, and the answer must differ from one. */
    const uint8_t *bytes = cursor->data ? cursor->data + cursor->offset : (const uint8_t *)"";
    cursor->offset += size;
    return bytes;
}

/* Little-endian by arithmetic: the same on every machine, and one load where the machine is little-endian. */
static uint64_t read_bytes(EnfCursor *cursor, unsigned size) {
    const uint8_t *bytes = enf_cursor_bytes(cursor, size);
    uint64_t value = 0;
    for (unsigned i = 0; bytes && i < size; i++) {
        value |= (uint64_t)bytes[i] << (8 * i);
    }
    return value;
}

uint8_t enf_cursor_u8(EnfCursor *cursor) {
    return (uint8_t)read_bytes(cursor, 1);
}

uint32_t enf_cursor_u32(EnfCursor *cursor) {
    return (uint32_t)read_bytes(cursor, 4);
}

uint64_t enf_cursor_u64(EnfCursor *cursor) {
    return read_bytes(cursor, 8);
}

float enf_cursor_f32(EnfCursor *cursor) {
    uint32_t bits = enf_cursor_u32(cursor);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double enf_cursor_f64(EnfCursor *cursor) {
    uint64_t bits = enf_cursor_u64(cursor);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
