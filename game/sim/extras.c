/* The few values that the rules need out of a node's extras: a flat JSON object as text, which the map's author wrote and nobody else
 * checked. A scan that never leaves the text; what it does not understand is absent. */
#include "sim/sim.h"

#include <string.h>

/* Past a string's closing quote, from its opening one; to the end of the text if there is none. */
static const char *skip_string(const char *at) {
    for (at++; *at && *at != '"'; at++) {
        if (*at == '\\' && at[1]) {
            at++;
        }
    }
    return *at ? at + 1 : at;
}

static const char *skip_blank(const char *at) {
    return at + strspn(at, " \t\r\n");
}

/* Past a value of any kind: strings whole, brackets by their depth. */
static const char *skip_value(const char *at) {
    int depth = 0;
    while (*at) {
        if (*at == '"') {
            at = skip_string(at);
        } else if (*at == '{' || *at == '[') {
            depth++;
            at++;
        } else if (*at == '}' || *at == ']') {
            if (depth == 0) {
                return at;
            }
            depth--;
            at++;
        } else if (*at == ',' && depth == 0) {
            return at;
        } else {
            at++;
        }
    }
    return at;
}

/* The value of a key, or NULL. */
static const char *find(const char *extras, const char *key) {
    size_t length = strlen(key);
    const char *at = skip_blank(extras);
    if (*at != '{') {
        return NULL;
    }
    for (at = skip_blank(at + 1); *at == '"'; at = skip_blank(at)) {
        const char *name = at + 1, *end = skip_string(at);
        bool here = (size_t)(end - name) == length + 1 && memcmp(name, key, length) == 0;
        at = skip_blank(end);
        if (*at != ':') {
            return NULL;
        }
        at = skip_blank(at + 1);
        if (here) {
            return at;
        }
        at = skip_blank(skip_value(at));
        if (*at != ',') {
            return NULL;
        }
        at++;
    }
    return NULL;
}

bool sim_extra(const char *extras, const char *key, char *out, size_t size) {
    const char *value = find(extras, key);
    out[0] = '\0';
    if (!value) {
        return false;
    }
    const char *end = skip_value(value);
    if (*value == '"') {
        end = skip_string(value);
        value++;
        end = end > value && end[-1] == '"' ? end - 1 : end;
    }
    size_t length = (size_t)(end - value);
    length = length < size ? length : size - 1;
    memcpy(out, value, length);
    out[length] = '\0';
    return true;
}

double sim_extra_number(const char *extras, const char *key, double standard) {
    char text[48];
    if (!sim_extra(extras, key, text, sizeof text)) {
        return standard;
    }
    const char *at = skip_blank(text);
    double sign = *at == '-' ? -1.0 : 1.0, value = 0.0, unit = 1.0;
    at += *at == '-' || *at == '+';
    bool digits = false;
    for (; *at >= '0' && *at <= '9'; at++) {
        value = value * 10.0 + (double)(*at - '0');
        digits = true;
    }
    for (at += *at == '.'; *at >= '0' && *at <= '9'; at++) {
        unit /= 10.0;
        value += unit * (double)(*at - '0');
        digits = true;
    }
    return digits ? sign * value : standard;
}

uint64_t sim_name(const char *text) {
    return text[0] ? enf_hash64(ENF_HASH_START, text, strlen(text)) : 0;
}
