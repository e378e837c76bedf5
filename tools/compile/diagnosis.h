/* What the compiler found strange: codes, node names, sentences, and (for the overlay) places. */
#ifndef ENFILADE_COMPILE_DIAGNOSIS_H
#define ENFILADE_COMPILE_DIAGNOSIS_H

#include <enfilade/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** X(NAME, "code", is_error): the catalogue; a test triggers each. The text code is what --json prints. */
#define ENF_DIAGNOSES(X)                                                                                                       \
    X(NO_ROOMS, "no-rooms", false)                      /* compiled as one cell */                                             \
    X(PORTAL_NO_TARGET, "portal-missing-target", false) /* names a room that is not there, or none found by geometry */        \
    X(PORTAL_SELF, "portal-to-itself", false)                                                                                  \
    X(PORTAL_OFF_PLANE, "portal-off-plane", false)                                                                             \
    X(PORTAL_CONCAVE, "portal-concave", false)                                                                                 \
    X(PORTAL_DEGENERATE, "portal-degenerate", false)                                                                           \
    X(PORTAL_FLIPPED, "portal-flipped", false)                                                                                 \
    X(PORTAL_DOUBLED, "portal-doubled", false)                                                                                 \
    X(PORTAL_FAR, "portal-far-from-room", false)                                                                               \
    X(PORTAL_OUTSIDE_ROOM, "portal-without-room", false)                                                                       \
    X(ROOM_DUPLICATE, "room-name-duplicate", false)                                                                            \
    X(ROOM_EMPTY, "room-empty", false)                                                                                         \
    X(ROOM_OVERLAP, "rooms-overlap", false)                                                                                    \
    X(ROOM_LEAK, "room-leak", false)                                                                                           \
    X(SUFFIX_NEAR_MISS, "suffix-near-miss", false)                                                                             \
    X(NODE_OUTSIDE, "node-outside-rooms", false)                                                                               \
    X(GEOMETRY_CROSSES, "geometry-crosses-rooms", false)                                                                       \
    X(NO_EXTRAS, "no-extras", false)                                                                                           \
    X(NO_LIGHTS, "no-lights", false)                                                                                           \
    X(DEGENERATE_TRIANGLES, "degenerate-triangles", false)                                                                     \
    X(UNSUPPORTED, "unsupported-feature", false) /* optional extension, primitive mode, morph, skin: what is lost */           \
    X(MOVER_KEY, "mover-key", false)             /* a key of extras that makes no sense, or is missing */                      \
    X(MOVER_STATIC, "mover-static", false)       /* something cannot move */                                                   \
    X(DOOR_PORTAL, "door-portal", false)         /* a door does not close its opening */                                       \
    X(IMAGE, "image-unreadable", false)                                                                                        \
    X(NO_GEOMETRY, "no-geometry", true)                                                                                        \
    X(TOO_LARGE, "too-large", true)

typedef enum EnfDiagnosisCode {
#define ENF_DIAGNOSIS_ENUM(name, text, error) ENF_DIAGNOSIS_##name,
    ENF_DIAGNOSES(ENF_DIAGNOSIS_ENUM)
#undef ENF_DIAGNOSIS_ENUM
        ENF_DIAGNOSIS_COUNT
} EnfDiagnosisCode;

typedef struct EnfFinding {
    EnfDiagnosisCode code;
    char *node; /**< glTF node name, or "" */
    char *message;
    EnfVec3 *points; /**< world polyline or polygon to show in the overlay; may be NULL */
    uint32_t point_count;
} EnfFinding;

typedef struct EnfDiagnosis {
    EnfFinding *findings;
    uint32_t count, capacity;
} EnfDiagnosis;

const char *enf_diagnosis_text(EnfDiagnosisCode code);
bool enf_diagnosis_is_error(EnfDiagnosisCode code);
/** Adds a finding (strings and points copied). `format` as printf. Out of memory drops it silently but counts it. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void enf_diagnose(EnfDiagnosis *diagnosis, EnfDiagnosisCode code, const char *node, const char *format, ...);
/** Attaches a place to the finding added last. */
void enf_diagnose_points(EnfDiagnosis *diagnosis, const EnfVec3 *points, uint32_t count);
void enf_diagnosis_free(EnfDiagnosis *diagnosis);

#ifdef __cplusplus
}
#endif
#endif
