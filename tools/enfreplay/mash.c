/* Random input: keys held for a moment, turns slow, wild or impossible, buttons in any combination, bits that no button has. */
#include "enfreplay/mash.h"

#include <string.h>

/* splitmix64 (Steele, Lea and Flood 2014). */
static uint64_t next_u64(Mash *mash) {
    uint64_t z = mash->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static uint32_t below(Mash *mash, uint32_t bound) {
    return (uint32_t)((next_u64(mash) >> 32) * bound >> 32);
}

Mash mash_begin(uint64_t seed, bool builder) {
    Mash mash;
    memset(&mash, 0, sizeof mash);
    mash.state = seed;
    mash.allowed = builder ? UINT32_MAX : ~(uint32_t)(ENF_BUTTON_NOCLIP | ENF_BUTTON_FLY);
    return mash;
}

static int16_t speed(Mash *mash) {
    static const int16_t usual[6] = {0, 0, 32767, 32767, -32767, -32768};
    uint32_t pick = below(mash, 8);
    return pick < 6 ? usual[pick] : (int16_t)((int32_t)below(mash, 65536) - 32768);
}

/* Mostly as a hand turns; one in 16 as no hand can. */
static int32_t turn(Mash *mash) {
    uint32_t pick = below(mash, 16);
    if (pick == 0) {
        uint32_t any = (uint32_t)next_u64(mash);
        return any <= INT32_MAX ? (int32_t)any : -(int32_t)(UINT32_MAX - any) - 1;
    }
    if (pick < 6) {
        return 0;
    }
    int32_t widest = pick < 13 ? 3 * ENF_INPUT_DEGREE : 30 * ENF_INPUT_DEGREE;
    return (int32_t)below(mash, (uint32_t)(2 * widest + 1)) - widest;
}

static uint32_t press(Mash *mash) {
    uint64_t half = next_u64(mash); /* each button one time in two; and of these, */
    uint32_t buttons = (uint32_t)(half & next_u64(mash)) & 127;
    if (below(mash, 256) == 0) {
        buttons = (uint32_t)next_u64(mash);
    }
    if (below(mash, 16) != 0) {
        buttons &= ~(uint32_t)(ENF_BUTTON_NOCLIP | ENF_BUTTON_FLY); /* too much of it is a fall into nowhere */
    }
    return buttons & mash->allowed;
}

EnfInput mash_next(Mash *mash) {
    if (mash->hold == 0) {
        mash->hold = 1 + (below(mash, 4) ? below(mash, 60) : below(mash, 4));
        mash->input.forward = speed(mash);
        mash->input.right = speed(mash);
        mash->input.yaw = turn(mash);
        mash->input.pitch = below(mash, 3) ? 0 : turn(mash);
        mash->input.buttons = press(mash);
    }
    mash->hold--;
    return mash->input;
}
