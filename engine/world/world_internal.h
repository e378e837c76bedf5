/* What the files of motions share: intervals and the evaluation of tracks. */
#ifndef ENFILADE_WORLD_INTERNAL_H
#define ENFILADE_WORLD_INTERNAL_H

#include <enfilade/world.h>

/** Components of a track at once. */
enum { ENF_TRACK_MAX = 4 };

/** An interval a component. */
typedef struct EnfTrackRange {
    double low[ENF_TRACK_MAX], high[ENF_TRACK_MAX];
} EnfTrackRange;

/** The track's value at `seconds`, glTF 2.0 §3.11 and appendix C; rotations (4 components) are normalised. */
void enf_track_value(const EnfTrack *track, uint32_t components, double seconds, double *out);

/** Widens `range` so that it holds every value that enf_track_value gives for times in [from, to], before normalisation of
 *  rotations. */
void enf_track_range(const EnfTrack *track, uint32_t components, double from, double to, EnfTrackRange *range);

#endif
