"""What the sounds are made of: noise, struck bodies, filters, voices, plucked notes.

A sound is a plain list of floats at RATE a second.  Only the standard library is used, noise comes from an own generator
seeded by name, and every resonance is a recurrence of two multiplications, so the same script gives the same bytes.
"""

import math
import struct
import wave

RATE = 22050


class Dice:
    """Numbers in [-1, 1) by a 64-bit congruential generator (Knuth's MMIX constants), seeded by a name."""

    def __init__(self, name):
        self.state = 0x9E3779B97F4A7C15
        for byte in name.encode():
            self.state = self._next(self.state ^ byte)

    @staticmethod
    def _next(state):
        return (state * 6364136223846793005 + 1442695040888963407) & 0xFFFFFFFFFFFFFFFF

    def __call__(self):
        self.state = self._next(self.state)
        return (self.state >> 32) / 2147483648.0 - 1.0

    def between(self, low, high):
        return low + (high - low) * (self() * 0.5 + 0.5)


def samples(seconds):
    return max(1, round(seconds * RATE))


def silence(seconds):
    return [0.0] * samples(seconds)


def noise(seconds, dice):
    return [dice() for _ in range(samples(seconds))]


def add(base, part, at=0.0, gain=1.0):
    """Adds `part` to `base`, `at` seconds into it; `base` grows as needed."""
    first = round(at * RATE)
    base += [0.0] * (first + len(part) - len(base))
    for i, value in enumerate(part, first):
        base[i] += gain * value
    return base


def add_round(base, part, at, gain=1.0):
    """As add, in a loop: what runs over the end goes on at the beginning."""
    first, length = round(at * RATE), len(base)
    for i, value in enumerate(part, first):
        base[i % length] += gain * value
    return base


def shaped(part, points):
    """Multiplied by straight lines through (seconds, gain)."""
    result, k = [], 0
    for i, value in enumerate(part):
        t = i / RATE
        while k + 2 < len(points) and t >= points[k + 1][0]:
            k += 1
        (t0, g0), (t1, g1) = points[k], points[k + 1]
        s = min(max((t - t0) / (t1 - t0), 0.0), 1.0)
        result.append(value * (g0 + (g1 - g0) * s))
    return result


def dying(part, half_life):
    """Halved every `half_life` seconds."""
    factor, gain, result = 0.5 ** (1.0 / (half_life * RATE)), 1.0, []
    for value in part:
        result.append(value * gain)
        gain *= factor
    return result


def low_pass(part, hertz):
    share, state, result = 1.0 - math.exp(-2 * math.pi * hertz / RATE), 0.0, []
    for value in part:
        state += share * (value - state)
        result.append(state)
    return result


def high_pass(part, hertz):
    return [a - b for a, b in zip(part, low_pass(part, hertz))]


def resonance(part, hertz, width):
    """A two-pole resonator of the given band width, of gain about one at its top."""
    r = math.exp(-math.pi * width / RATE)
    turn, square = 2 * r * math.cos(2 * math.pi * hertz / RATE), r * r
    gain, y1, y2, result = (1.0 - r) * math.sqrt(1.0 + square - 2 * r * math.cos(4 * math.pi * hertz / RATE)), 0.0, 0.0, []
    for value in part:
        y = gain * value + turn * y1 - square * y2
        y1, y2 = y, y1
        result.append(y)
    return result


def struck(seconds, modes):
    """A body that was struck: modes are (hertz, half-life in seconds, gain); each starts at zero, as a sine does."""
    result = silence(seconds)
    for hertz, half_life, gain in modes:
        r, angle = 0.5 ** (1.0 / (half_life * RATE)), 2 * math.pi * hertz / RATE
        turn, square, y1, y2 = 2 * r * math.cos(angle), r * r, gain * math.sin(angle), 0.0
        for i in range(1, len(result)):
            result[i] += y1
            y1, y2 = turn * y1 - square * y2, y1
    return result


def pulses(seconds, rate, dice, wobble=0.0):
    """A train of pulses; `rate` is a function of the time, in hertz; `wobble` the share by which gaps differ."""
    result, due = silence(seconds), 0.0
    while due < seconds:
        at = round(due * RATE)
        if at < len(result):
            result[at] = 1.0 + 0.5 * wobble * dice()
        due += (1.0 + wobble * dice()) / max(rate(due), 1.0)
    return result


def voice(seconds, pitch, formants, dice, breath=0.03):
    """A throat: pulses at `pitch(t)` hertz through formants, each a function of the time that gives (hertz, width, gain)."""
    phase, drive = 0.0, []
    for i in range(samples(seconds)):
        phase += pitch(i / RATE) / RATE
        phase -= math.floor(phase)
        drive.append((1.0 - phase / 0.6) * phase * 4.0 if phase < 0.6 else -0.1)
    drive = [a + breath * dice() for a in drive]
    drive = [b - 0.9 * a for a, b in zip([0.0] + drive, drive)]
    result = [0.0] * len(drive)
    for formant in formants:
        y1 = y2 = 0.0
        for i, value in enumerate(drive):
            if i % 64 == 0:
                hertz, width, gain = formant(i / RATE)
                r = math.exp(-math.pi * width / RATE)
                turn, square = 2 * r * math.cos(2 * math.pi * hertz / RATE), r * r
                scale = gain * (1.0 - r)
            y = scale * value + turn * y1 - square * y2
            y1, y2 = y, y1
            result[i] += y
    return high_pass(high_pass(result, 180), 180)


def tone(seconds, hertz, partials, trill=0.0):
    """A held note: partials are gains of its multiples; `trill` the depth of a vibrato of 5 Hz, in shares of the pitch."""
    phase, result = 0.0, []
    for i in range(samples(seconds)):
        phase += hertz * (1.0 + trill * math.sin(2 * math.pi * 5.0 * i / RATE)) / RATE
        result.append(sum(g * math.sin(2 * math.pi * phase * (k + 1)) for k, g in enumerate(partials)))
    return result


def pluck(hertz, bright=1.0, half_life=0.35):
    """A plucked or struck string: partials die the faster the higher they are."""
    modes = [(hertz * k * (1.0 + 0.0004 * k * k), half_life / k**0.7, bright ** (k - 1) / k) for k in range(1, 8) if hertz * k < 9000]
    return struck(min(6 * half_life, 3.0), modes)


def horn(seconds, hertz):
    """A horn's note: it opens up as it swells."""
    body = tone(seconds, hertz, [1.0, 0.7, 0.55, 0.4, 0.25, 0.15, 0.1], 0.003)
    dark = tone(seconds, hertz, [1.0, 0.35, 0.12])
    swell = shaped(body, [(0.0, 0.0), (0.09, 1.0), (seconds - 0.12, 0.7), (seconds, 0.0)])
    return add(swell, shaped(dark, [(0.0, 0.0), (0.04, 0.6), (seconds - 0.08, 0.5), (seconds, 0.0)]))


def midi(number):
    return 440.0 * 2.0 ** ((number - 69) / 12)


def loop(part, seconds):
    """The last `seconds` of a part fade into its first ones: what remains can be played round and round."""
    n = samples(seconds)
    head, body, tail = part[:n], part[n:-n], part[-n:]
    mixed = [a * math.sqrt(i / n) + b * math.sqrt(1.0 - i / n) for i, (a, b) in enumerate(zip(head, tail))]
    return mixed + body


def finished(part, peak, edges=True):
    """Scaled to `peak` of full scale; unless it is a loop, both ends are faded so that nothing clicks."""
    mean = sum(part) / len(part)
    part = [value - mean for value in part]
    if edges:
        part = part[: _last_heard(part)]
        ins, outs = min(16, len(part)), min(400, len(part) // 4)
        part = [v * min(1.0, i / ins, (len(part) - 1 - i) / max(outs, 1)) for i, v in enumerate(part)]
    top = max(max(part), -min(part), 1e-9)
    return [value * peak / top for value in part]


def _last_heard(part):
    """How much of a part is left when it has died away to a two-hundredth of its peak."""
    quiet = max(max(part), -min(part)) / 200.0
    return next((i for i in range(len(part), 1, -1) if abs(part[i - 1]) > quiet), 1)


def write(path, part):
    with wave.open(path, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(struct.pack(f"<{len(part)}h", *(round(32767 * min(max(v, -1.0), 1.0)) for v in part)))
