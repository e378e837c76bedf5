/* Checksums and hashes: CRC-32C for files, a 64-bit hash for results.
 *
 * The CRC works on eight bytes a step with eight tables ("slicing by 8": Kounavis & Berry, "A Systematic Approach to
 * Building High Performance Software-based CRC Generators", 2005). A CRC is linear over GF(2), so entry i of a table is
 * the exclusive or of the entries of i's bits: the eight numbers a row below define their whole table, at compile
 * time. */
#include <enfilade/base.h>

#include <string.h>

/* ---- CRC-32C ---------------------------------------------------------------------------------------------------- */

#define BIT(i, b, c) ((i) >> (b)&1u ? (c) : 0u)
#define ENTRY(i, a, b, c, d, e, f, g, h)                                                                                       \
    (BIT(i, 0, a) ^ BIT(i, 1, b) ^ BIT(i, 2, c) ^ BIT(i, 3, d) ^ BIT(i, 4, e) ^ BIT(i, 5, f) ^ BIT(i, 6, g) ^ BIT(i, 7, h))

/* Row k: the remainder of each bit of a byte that is followed by k bytes of zero; polynomial 0x1EDC6F41, reflected. */
/* clang-format off */
#define ROW0(i) ENTRY(i, 0xf26b8303, 0xe13b70f7, 0xc79a971f, 0x8ad958cf, 0x105ec76f, 0x20bd8ede, 0x417b1dbc, 0x82f63b78)
#define ROW1(i) ENTRY(i, 0x13a29877, 0x274530ee, 0x4e8a61dc, 0x9d14c3b8, 0x3fc5f181, 0x7f8be302, 0xff17c604, 0xfbc3faf9)
#define ROW2(i) ENTRY(i, 0xa541927e, 0x4f6f520d, 0x9edea41a, 0x38513ec5, 0x70a27d8a, 0xe144fb14, 0xc76580d9, 0x8b277743)
#define ROW3(i) ENTRY(i, 0xdd45aab8, 0xbf672381, 0x7b2231f3, 0xf64463e6, 0xe964b13d, 0xd725148b, 0xaba65fe7, 0x52a0c93f)
#define ROW4(i) ENTRY(i, 0x38116fac, 0x7022df58, 0xe045beb0, 0xc5670b91, 0x8f2261d3, 0x1ba8b557, 0x37516aae, 0x6ea2d55c)
#define ROW5(i) ENTRY(i, 0xef306b19, 0xdb8ca0c3, 0xb2f53777, 0x6006181f, 0xc00c303e, 0x85f4168d, 0x0e045beb, 0x1c08b7d6)
#define ROW6(i) ENTRY(i, 0x68032cc8, 0xd0065990, 0xa5e0c5d1, 0x4e2dfd53, 0x9c5bfaa6, 0x3d5b83bd, 0x7ab7077a, 0xf56e0ef4)
#define ROW7(i) ENTRY(i, 0x493c7d27, 0x9278fa4e, 0x211d826d, 0x423b04da, 0x847609b4, 0x0d006599, 0x1a00cb32, 0x34019664)
/* clang-format on */

#define FOUR(row, i) row((i)), row((i) + 1u), row((i) + 2u), row((i) + 3u)
#define SIXTEEN(row, i) FOUR(row, (i)), FOUR(row, (i) + 4u), FOUR(row, (i) + 8u), FOUR(row, (i) + 12u)
#define SIXTYFOUR(row, i) SIXTEEN(row, (i)), SIXTEEN(row, (i) + 16u), SIXTEEN(row, (i) + 32u), SIXTEEN(row, (i) + 48u)
#define TABLE(row)                                                                                                             \
    { SIXTYFOUR(row, 0u), SIXTYFOUR(row, 64u), SIXTYFOUR(row, 128u), SIXTYFOUR(row, 192u) }

static const uint32_t crc_table[8][256] = {TABLE(ROW0), TABLE(ROW1), TABLE(ROW2), TABLE(ROW3),
                                           TABLE(ROW4), TABLE(ROW5), TABLE(ROW6), TABLE(ROW7)};

/* Compilers make one load of it where the machine is little-endian. */
static uint32_t load_u32(const uint8_t *p) {
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint64_t load_u64(const uint8_t *p) {
    return load_u32(p) | (uint64_t)load_u32(p + 4) << 32;
}

static uint32_t crc_eight_bytes(uint32_t crc, const uint8_t *p) {
    uint32_t low = crc ^ load_u32(p), high = load_u32(p + 4);
    return crc_table[7][low & 255] ^ crc_table[6][low >> 8 & 255] ^ crc_table[5][low >> 16 & 255] ^ crc_table[4][low >> 24] ^
           crc_table[3][high & 255] ^ crc_table[2][high >> 8 & 255] ^ crc_table[1][high >> 16 & 255] ^ crc_table[0][high >> 24];
}

uint32_t enf_crc32c(uint32_t crc, const void *data, size_t size) {
    const uint8_t *p = data;
    crc = ~crc;
    for (; size >= 8; size -= 8, p += 8) {
        crc = crc_eight_bytes(crc, p);
    }
    for (; size > 0; size--, p++) {
        crc = crc >> 8 ^ crc_table[0][(crc ^ *p) & 255];
    }
    return ~crc;
}

/* ---- 64-bit hash ------------------------------------------------------------------------------------------------ */

/* The first 64 bits of the fractions of the golden ratio, sqrt(2) and sqrt(3), made odd. */
#define MIX_A UINT64_C(0x9e3779b97f4a7c15)
#define MIX_B UINT64_C(0x6a09e667f3bcc909)
#define MIX_C UINT64_C(0xbb67ae8584caa73b)

/* The word is mixed before it meets the state: without that, flipping the top bits of two neighbours (the signs of two
 * doubles) would cancel. Both halves are bijections, so one changed word always changes the state. */
static uint64_t hash_word(uint64_t hash, uint64_t word) {
    word *= MIX_A;
    word ^= word >> 29;
    word *= MIX_B;
    hash = (hash ^ word) * MIX_C;
    return hash ^ hash >> 32;
}

static uint64_t hash_finish(uint64_t hash) {
    hash *= MIX_A;
    hash ^= hash >> 31;
    hash *= MIX_B;
    return hash ^ hash >> 29;
}

uint64_t enf_hash64(uint64_t hash, const void *data, size_t size) {
    const uint8_t *p = data;
    /* The length goes in first, so that zeros at the end of a shorter string count. */
    hash = (hash ^ (uint64_t)size) * MIX_C;
    hash ^= hash >> 32;
    for (; size >= 8; size -= 8, p += 8) {
        hash = hash_word(hash, load_u64(p));
    }
    if (size > 0) {
        uint64_t word = 0;
        for (size_t i = 0; i < size; i++) {
            word |= (uint64_t)p[i] << (8 * i);
        }
        hash = hash_word(hash, word);
    }
    return hash_finish(hash);
}
