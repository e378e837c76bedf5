#!/usr/bin/env python3
"""Synthesises every sound of the game: WAV, 22,050 Hz, mono, 16 bits.  Standard library only; the same bytes every time.

    python3 assets/sounds/synth.py            writes the .wav files beside this script
    python3 assets/sounds/synth.py --check    compares them with what it would write
"""

import argparse
import math
import os
import sys
import tempfile

from waves import (
    Dice,
    add,
    add_round,
    dying,
    finished,
    high_pass,
    horn,
    loop,
    low_pass,
    midi,
    noise,
    pluck,
    pulses,
    resonance,
    samples,
    shaped,
    silence,
    struck,
    tone,
    voice,
    write,
)

# ---- steps and bodies ----------------------------------------------------------------------------------------------

FLOORS = {  # modes of heel and floor; click of the sole: pass band in hertz, half-life, gain; scuff gain
    "stone": ([(95, 0.018, 0.5), (310, 0.008, 0.35), (1150, 0.005, 0.2)], (1800, 0.006, 1.1), 0.10),
    "wood": ([(82, 0.03, 1.0), (178, 0.022, 0.7), (265, 0.014, 0.4), (520, 0.007, 0.2)], (900, 0.007, 0.6), 0.06),
    "carpet": ([(60, 0.022, 0.8), (120, 0.012, 0.35)], (320, 0.014, 0.7), 0.12),
}


def step(floor, dice):
    """Heel, and the ball of the foot a little later."""
    modes, (band, half_life, click), scuff = FLOORS[floor]
    sound = silence(0.26)
    for at, gain in ((0.0, 1.0), (dice.between(0.055, 0.08), 0.45)):
        pitch = dice.between(0.9, 1.12)
        add(sound, struck(0.16, [(h * pitch, life, g) for h, life, g in modes]), at, gain)
        add(sound, dying(resonance(noise(0.08, dice), band * pitch, band * 0.9), half_life), at, gain * click)
    brush = shaped(resonance(noise(0.12, dice), band * 1.4, band), [(0, 0), (0.05, 1), (0.12, 0)])
    return add(sound, brush, 0.04, scuff)


def jump(dice):
    cloth = shaped(resonance(noise(0.22, dice), 900, 800), [(0, 0), (0.05, 1), (0.22, 0)])
    return add(shaped(voice(0.2, lambda t: 120 + 90 * t, _vowel("u"), dice, 0.3), [(0, 0), (0.03, 0.6), (0.2, 0)]), cloth, 0.0, 0.7)


def land(dice):
    sound = struck(0.4, [(48, 0.05, 1.2), (92, 0.035, 0.8), (170, 0.015, 0.4)])
    add(sound, dying(low_pass(noise(0.3, dice), 900), 0.03), 0.0, 1.0)
    return add(sound, dying(low_pass(noise(0.2, dice), 600), 0.02), 0.07, 0.6)


# ---- doors, switches, the lift ---------------------------------------------------------------------------------------

WOOD = [(130, 0.03, 1.0), (245, 0.025, 0.6), (410, 0.016, 0.35), (700, 0.01, 0.2)]
METAL = [(2100, 0.012, 0.6), (3350, 0.009, 0.5), (5200, 0.006, 0.3)]


def latch(dice, gain=1.0):
    sound = silence(0.12)
    for at, part in ((0.0, 0.7), (0.028, 1.0)):
        add(sound, struck(0.08, [(h * dice.between(0.95, 1.05), life, g * gain) for h, life, g in METAL]), at, part)
        add(sound, struck(0.08, WOOD), at, 0.25 * part)
    return sound


def creak(seconds, dice, low, high):
    """Stick and slip: pulses that quicken and slacken, through the resonances of a panel."""
    drive = pulses(seconds, lambda t: low + (high - low) * math.sin(math.pi * min(t / seconds, 1.0)) ** 2, dice, 0.25)
    sound = silence(seconds)
    for hertz, width, gain in ((540, 60, 1.0), (910, 80, 0.8), (1480, 120, 0.6), (2300, 200, 0.3)):
        add(sound, resonance(drive, hertz, width), 0.0, gain * 8.0)
    return shaped(sound, [(0, 0), (0.15 * seconds, 0.7), (0.6 * seconds, 1.0), (seconds, 0)])


def door_open(dice):
    return add(add(latch(dice), creak(0.85, dice, 22, 75), 0.1, 0.6), low_pass(noise(0.5, dice), 300), 0.15, 0.06)


def door_close(dice):
    sound = add(silence(0.1), creak(0.3, dice, 30, 60), 0.0, 0.35)
    add(sound, struck(0.5, [(62, 0.06, 1.6), (118, 0.05, 1.0)] + WOOD), 0.32, 1.0)
    add(sound, dying(low_pass(noise(0.3, dice), 1200), 0.02), 0.32, 1.2)
    return add(sound, latch(dice), 0.34, 0.5)


def door_locked(dice):
    sound = silence(0.55)
    for at in (0.0, 0.11, 0.3):
        add(sound, latch(dice), at, 0.6)
        add(sound, struck(0.2, WOOD), at + 0.02, 0.9)
    return sound


def unlock(dice):
    sound = silence(0.6)
    for i in range(4):
        add(sound, struck(0.06, [(h * dice.between(1.1, 1.4), life, g) for h, life, g in METAL]), 0.05 * i, 0.35)
    return add(add(sound, latch(dice), 0.32, 1.2), struck(0.2, WOOD), 0.35, 0.9)


def door_slide(dice):
    sound = shaped(resonance(noise(0.9, dice), 420, 500), [(0, 0), (0.2, 1), (0.75, 0.8), (0.9, 0)])
    return add(sound, struck(0.2, WOOD), 0.8, 1.0)


def switch_click(dice):
    return add(add(latch(dice, 0.5), struck(0.1, [(1500, 0.008, 1.0), (620, 0.012, 0.6)])), struck(0.1, [(1900, 0.006, 0.8)]), 0.06, 0.7)


def motor(seconds, speed, dice):
    """The lift's motor: hum of the mains, whine of a worm gear; `speed(t)` from 0 to 1."""
    sound, a, b = [], 0.0, 0.0
    rumble = low_pass(noise(seconds, dice), 180)
    for i in range(samples(seconds)):
        v = speed(i / RATE_OF)
        a += (40 + 8 * v) / RATE_OF
        b += (60 + 180 * v) / RATE_OF
        hum = 0.6 * math.sin(2 * math.pi * a) + 0.35 * math.sin(4 * math.pi * a) + 0.2 * math.sin(6 * math.pi * a + 1.0)
        whine = 0.16 * math.sin(2 * math.pi * b) + 0.08 * math.sin(4 * math.pi * b)
        sound.append(v * (hum + whine + 1.2 * rumble[i]))
    return sound


RATE_OF = samples(1.0)


def lift_start(dice):
    return add(motor(0.9, lambda t: min(1.0, t / 0.8), dice), struck(0.3, [(72, 0.05, 1.0), (900, 0.01, 0.5)]), 0.0, 0.9)


def lift_stop(dice):
    return add(motor(0.8, lambda t: max(0.0, 1.0 - t / 0.6), dice), struck(0.4, [(58, 0.06, 1.2), (300, 0.02, 0.5)]), 0.55, 1.0)


def lift_hum(dice):
    """Two seconds, of which both tones are whole numbers of periods; the rumble is faded over."""
    return loop(motor(2.25, lambda t: 1.0, dice), 0.25)


def lift_ding(_dice):
    return bell(1174.7, 1.3)


# ---- bells, clocks, the train ------------------------------------------------------------------------------------------


def bell(hertz, seconds, dark=1.0):
    """A bell's partials: hum, prime, minor third, fifth, nominal and above."""
    rows = [(0.5, 1.0, 0.4), (1.0, 0.7, 1.0), (1.19, 0.5, 0.5), (1.5, 0.35, 0.3), (2.0, 0.4, 0.7), (2.74, 0.2, 0.3), (3.76, 0.12, 0.2)]
    return struck(seconds, [(hertz * m, 0.35 * seconds * life, g * (dark if m > 1.6 else 1.0)) for m, life, g in rows])


def tick(hertz, dice):
    sound = struck(0.07, [(hertz, 0.006, 1.0), (hertz * 2.3, 0.004, 0.6), (hertz * 0.31, 0.009, 0.5)])
    return add(sound, dying(high_pass(noise(0.02, dice), 3000), 0.002), 0.0, 0.3)


def chime(_dice):
    """The quarter: four bells, a turn of our own."""
    sound = silence(3.0)
    for i, note in enumerate((76, 71, 74, 67)):
        add(sound, bell(midi(note), 1.5, 0.5), 0.42 * i, 0.8)
    return sound[: samples(3.0)]


def strike(_dice):
    """The hour, once."""
    return bell(midi(52), 2.0, 0.6)


def train(dice):
    """Four chuffs and the wheels over a joint, in a loop of a second and a half."""
    sound = [0.25 * v for v in loop(low_pass(noise(1.6, dice), 260), 0.1)]
    for i in range(4):
        puff = dying(resonance(noise(0.2, dice), 900 + 60 * (i % 2), 900), 0.04)
        add_round(sound, puff, 0.375 * i, 1.0 if i == 0 else 0.7)
    for at in (0.1, 0.22, 0.85, 0.97):
        add_round(sound, struck(0.1, [(1850, 0.008, 0.4), (760, 0.01, 0.4)]), at, 0.5)
    return sound


def train_whistle(dice):
    sound = silence(1.1)
    for at, long in ((0.0, 0.25), (0.35, 0.7)):
        note = tone(long, 784.0, [0.8, 0.2], 0.004)
        add(note, tone(long, 988.0, [0.6, 0.1], 0.004))
        add(note, resonance(noise(long, dice), 1600, 900), 0.0, 0.2)
        add(sound, shaped(note, [(0, 0), (0.05, 1), (long - 0.1, 0.9), (long, 0)]), at)
    return sound


# ---- guards ---------------------------------------------------------------------------------------------------------

VOWELS = {
    "m": ((250, 60, 1.0), (1100, 150, 0.08), (2100, 200, 0.03)),
    "u": ((320, 70, 1.0), (800, 90, 0.5), (2250, 150, 0.1)),
    "e": ((530, 80, 1.0), (1840, 110, 0.6), (2480, 160, 0.35)),
    "i": ((270, 60, 1.0), (2290, 120, 0.5), (3010, 180, 0.3)),
    "o": ((570, 80, 1.0), (840, 90, 0.6), (2410, 150, 0.15)),
    "a": ((730, 90, 1.0), (1090, 100, 0.6), (2440, 160, 0.25)),
}


def _vowel(name, then=None, seconds=1.0):
    """Formants that glide from one vowel to another."""

    def glide(k):
        a, b = VOWELS[name][k], VOWELS[then or name][k]
        return lambda t: tuple(x + (y - x) * min(t / seconds, 1.0) for x, y in zip(a, b))

    return [glide(k) for k in range(3)]


def guard_hm(dice):
    """A question: closed lips, rising."""
    sound = voice(0.5, lambda t: 98 + 130 * max(0.0, t - 0.12) ** 1.3, _vowel("m"), dice)
    return shaped(sound, [(0, 0), (0.06, 0.8), (0.36, 1.0), (0.5, 0)])


def guard_alert(dice):
    """A call: "hey!"."""
    breath = shaped(resonance(noise(0.12, dice), 1500, 1200), [(0, 0), (0.08, 1), (0.12, 0.2)])
    call = voice(0.5, lambda t: 165 + 60 * math.sin(min(t / 0.4, 1.0) * math.pi) - 40 * t, _vowel("e", "i", 0.4), dice)
    return add(breath, shaped(call, [(0, 0), (0.04, 1), (0.35, 0.9), (0.5, 0)]), 0.07, 1.6)


def guard_lost(dice):
    """He gives up: "oh - mm", falling."""
    sound = voice(0.7, lambda t: 125 - 45 * t, _vowel("o", "m", 0.35), dice)
    return shaped(sound, [(0, 0), (0.07, 1), (0.4, 0.7), (0.7, 0)])


def guard_whistle(dice):
    """A pea whistle: the pea beats the tone thirty times a second."""
    sound = silence(1.0)
    for at, long in ((0.0, 0.28), (0.36, 0.6)):
        phase, note = 0.0, []
        for i in range(samples(long)):
            t = i / RATE_OF
            beat = math.sin(2 * math.pi * 31.0 * t)
            phase += (2750 + 110 * beat) / RATE_OF
            note.append((0.65 + 0.35 * beat) * math.sin(2 * math.pi * phase) + 0.12 * dice())
        add(sound, shaped(note, [(0, 0), (0.03, 1), (long - 0.06, 1), (long, 0)]), at)
    return sound


def caught(_dice):
    """Horns: a minor second that falls; the guards have seen him."""
    sound = silence(1.5)
    for at, long, notes in ((0.0, 0.22, (57, 64)), (0.24, 1.1, (58, 61, 65))):
        for note in notes:
            add(sound, horn(long, midi(note)), at, 0.5)
    return sound


# ---- things taken, menu, music ----------------------------------------------------------------------------------------


def arpeggio(notes, gap, half_life, bright=0.8):
    sound = silence(0.1)
    for i, note in enumerate(notes):
        add(sound, pluck(midi(note), bright, half_life), gap * i, 0.7)
    return sound


def pick_up(_dice):
    return arpeggio((76, 79, 83, 88), 0.06, 0.12)


def pick_up_key(dice):
    sound = arpeggio((84, 91), 0.07, 0.1)
    for i in range(3):
        add(sound, struck(0.12, [(h * dice.between(1.2, 1.5), 0.02, g) for h, _, g in METAL]), 0.05 * i, 0.4)
    return sound


def put_down(dice):
    return add(struck(0.3, WOOD), dying(low_pass(noise(0.1, dice), 700), 0.015), 0.0, 0.8)


def delivered(_dice):
    return arpeggio((67, 71, 74, 79, 83), 0.09, 0.2)


def menu_move(_dice):
    return struck(0.06, [(1320, 0.012, 0.7), (660, 0.012, 0.5)])


def menu_select(_dice):
    return arpeggio((79, 86), 0.07, 0.08)


def menu_back(_dice):
    return arpeggio((79, 72), 0.07, 0.08)


def win(_dice):
    """A fanfare: the major triad climbs and stays."""
    sound = silence(3.6)
    for at, long, notes in ((0.0, 0.2, (67,)), (0.22, 0.2, (72,)), (0.44, 0.2, (76,)), (0.66, 0.5, (79, 72)), (1.2, 0.25, (77, 69)), (1.48, 1.9, (79, 76, 72, 60))):
        for note in notes:
            add(sound, horn(long, midi(note)), at, 0.45)
    return sound


def lose(_dice):
    sound = silence(3.2)
    for at, long, notes in ((0.0, 0.5, (64, 57)), (0.55, 0.5, (63, 57)), (1.1, 0.5, (62, 56)), (1.65, 1.4, (57, 53, 45))):
        for note in notes:
            add(sound, horn(long, midi(note)), at, 0.45)
    return sound


TITLE_BEAT = 0.46
TITLE_BARS = [  # bass, chord broken upwards, tune on the beats of three (None: held)
    (45, (57, 60, 64), (76, None, 74)),
    (41, (57, 60, 65), (72, None, 69)),
    (38, (57, 62, 65), (74, None, 72)),
    (40, (56, 59, 64), (71, None, None)),
    (45, (57, 60, 64), (72, 74, 76)),
    (43, (55, 59, 62), (79, None, 74)),
    (36, (55, 60, 64), (76, None, 72)),
    (40, (56, 59, 62), (71, None, 68)),
]


def title(_dice):
    """A waltz for a musical box and low strings, eight bars, in a loop."""
    sound = silence(TITLE_BEAT * 3 * len(TITLE_BARS))
    for bar, (bass, chord, tune) in enumerate(TITLE_BARS):
        start = 3 * TITLE_BEAT * bar
        add_round(sound, pluck(midi(bass), 0.5, 0.5), start, 0.8)
        for i, note in enumerate(chord):
            add_round(sound, pluck(midi(note), 0.55, 0.3), start + TITLE_BEAT * i, 0.35)
        for i, note in enumerate(tune):
            if note:
                add_round(sound, pluck(midi(note + 12), 0.35, 0.45), start + TITLE_BEAT * i, 0.55)
        low = shaped(tone(3 * TITLE_BEAT, midi(bass + 12), [0.5, 0.25, 0.12], 0.004), [(0, 0), (0.4, 1), (1.0, 0.9), (3 * TITLE_BEAT, 0)])
        add_round(sound, low, start, 0.16)
    return sound


# ---- places -----------------------------------------------------------------------------------------------------------


def night(dice):
    """Wind about the house, and two crickets; six seconds round."""
    wind = resonance(low_pass(noise(7.0, dice), 500), 240, 260)
    wind = [v * (0.7 + 0.3 * math.sin(2 * math.pi * i / samples(4.0))) for i, v in enumerate(wind)]
    sound = [2.5 * v for v in loop(wind, 1.0)]
    for start, hertz, gain in ((0.4, 4150, 0.05), (1.1, 4480, 0.03)):
        for k in range(5):
            for i in range(3):
                chirp = shaped(tone(0.03, hertz, [1.0]), [(0, 0), (0.008, 1), (0.03, 0)])
                add_round(sound, chirp, start + 1.2 * k + 0.045 * i, gain)
    return sound


def fountain(dice):
    """Water: noise, and drops that each ring for a moment, rising."""
    sound = [0.5 * v for v in loop(resonance(noise(3.5, dice), 1500, 1800), 0.5)]
    for _ in range(140):
        add_round(sound, dying(tone(0.05, dice.between(500, 2400), [1.0]), 0.008), dice.between(0.0, 3.0), dice.between(0.05, 0.3))
    return sound


def chirp(notes):
    def build(_dice):
        sound = silence(0.1)
        for i, (f0, f1) in enumerate(notes):
            phase, part = 0.0, []
            for k in range(samples(0.09)):
                phase += (f0 + (f1 - f0) * k / samples(0.09)) / RATE_OF
                part.append(math.sin(2 * math.pi * phase))
            add(sound, shaped(part, [(0, 0), (0.02, 1), (0.09, 0)]), 0.12 * i)
        return sound

    return build


def wings(dice):
    """One wing of the revolving door goes by."""
    return shaped(resonance(noise(0.7, dice), 380, 350), [(0, 0), (0.3, 1), (0.7, 0)])


# ---- the table ----------------------------------------------------------------------------------------------------------

SOUNDS = {  # name: (how, peak of full scale, a loop)
    **{f"step_{floor}_{k}": (lambda dice, floor=floor: step(floor, dice), 0.7 if floor != "carpet" else 0.4, False) for floor in FLOORS for k in range(1, 5)},
    "jump": (jump, 0.35, False),
    "land": (land, 0.75, False),
    "door_open": (door_open, 0.6, False),
    "door_close": (door_close, 0.8, False),
    "door_locked": (door_locked, 0.7, False),
    "door_unlock": (unlock, 0.6, False),
    "door_slide": (door_slide, 0.6, False),
    "switch": (switch_click, 0.6, False),
    "lift_start": (lift_start, 0.6, False),
    "lift_hum": (lift_hum, 0.45, True),
    "lift_stop": (lift_stop, 0.6, False),
    "lift_ding": (lift_ding, 0.5, False),
    "clock_tick": (lambda dice: tick(2600, dice), 0.35, False),
    "clock_tock": (lambda dice: tick(2050, dice), 0.35, False),
    "clock_chime": (chime, 0.6, False),
    "clock_strike": (strike, 0.7, False),
    "train": (train, 0.5, True),
    "train_whistle": (train_whistle, 0.5, False),
    "guard_hm": (guard_hm, 0.7, False),
    "guard_alert": (guard_alert, 0.9, False),
    "guard_lost": (guard_lost, 0.7, False),
    "guard_whistle": (guard_whistle, 0.8, False),
    "caught": (caught, 0.85, False),
    "pick_up": (pick_up, 0.6, False),
    "pick_up_key": (pick_up_key, 0.6, False),
    "put_down": (put_down, 0.6, False),
    "delivered": (delivered, 0.7, False),
    "menu_move": (menu_move, 0.4, False),
    "menu_select": (menu_select, 0.5, False),
    "menu_back": (menu_back, 0.5, False),
    "win": (win, 0.8, False),
    "lose": (lose, 0.8, False),
    "title": (title, 0.6, True),
    "night": (night, 0.35, True),
    "fountain": (fountain, 0.5, True),
    "bird_1": (chirp([(3200, 4100), (3900, 3000), (3300, 4300)]), 0.4, False),
    "bird_2": (chirp([(2700, 3500), (2700, 3600)]), 0.4, False),
    "wings": (wings, 0.5, False),
}


def synthesise(folder):
    for name, (how, peak, is_loop) in SOUNDS.items():
        write(os.path.join(folder, name + ".wav"), finished(how(Dice(name)), peak, not is_loop))


def differing(folder):
    """Names of the files in `folder` that are not what this script writes."""
    with tempfile.TemporaryDirectory() as fresh:
        synthesise(fresh)
        names = {n for n in os.listdir(folder) if n.endswith(".wav")} | set(os.listdir(fresh))
        return sorted(n for n in names if _bytes(folder, n) != _bytes(fresh, n))


def _bytes(folder, name):
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        return None
    with open(path, "rb") as file:
        return file.read()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=os.path.dirname(os.path.abspath(__file__)), help="folder")
    parser.add_argument("--check", action="store_true", help="compare, write nothing")
    options = parser.parse_args()
    if not options.check:
        synthesise(options.output)
        return 0
    wrong = differing(options.output)
    print("\n".join(f"differs: {name}" for name in wrong) or f"{len(SOUNDS)} sounds, 0 differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
