/* Text → lines, words, numbers. */
#include "sim/text.h"

#include <string.h>

#define NUMBER_MOST 1e9

bool sim_text_line(SimText *text, SimText *line) {
    if (text->at >= text->end) {
        return false;
    }
    const char *stop = memchr(text->at, '\n', (size_t)(text->end - text->at));
    const char *next = stop ? stop + 1 : text->end;
    stop = stop ? stop : text->end;
    stop -= stop > text->at && stop[-1] == '\r';
    *line = (SimText){text->at, stop};
    text->at = next;
    return true;
}

static bool blank(char c) {
    return c == ' ' || c == '\t';
}

bool sim_text_word(SimText *line, char comma, char *word, size_t size) {
    word[0] = '\0';
    while (line->at < line->end && blank(*line->at)) {
        line->at++;
    }
    if (line->at >= line->end) {
        return false;
    }
    const char *first = line->at;
    while (line->at < line->end && *line->at != comma && (comma || !blank(*line->at))) {
        line->at++;
    }
    const char *last = line->at;
    line->at += line->at < line->end && comma;
    while (last > first && blank(last[-1])) {
        last--;
    }
    size_t length = (size_t)(last - first);
    if (length >= size || memchr(first, '\0', length)) {
        return false;
    }
    memcpy(word, first, length);
    word[length] = '\0';
    return true;
}

bool sim_text_number(const char *word, double *value) {
    const char *at = word + (*word == '-' || *word == '+');
    double sum = 0.0, unit = 1.0;
    uint32_t digits = 0;
    for (; *at >= '0' && *at <= '9'; at++, digits++) {
        sum = sum * 10.0 + (double)(*at - '0');
    }
    for (at += *at == '.'; *at >= '0' && *at <= '9'; at++, digits++) {
        sum = sum * 10.0 + (double)(*at - '0');
        unit *= 10.0;
    }
    /* 15 digits and 10^15 are whole numbers of a double, and their quotient is rounded once. */
    if (*at || digits == 0 || digits > 15 || sum / unit > NUMBER_MOST) {
        return false;
    }
    *value = *word == '-' ? -(sum / unit) : sum / unit;
    return true;
}
