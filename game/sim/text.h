/* Text that a person wrote and nobody checked: lines, words, numbers. Nothing here reads past the end, needs a zero there, or asks
 * the locale. */
#ifndef ENF_GAME_SIM_TEXT_H
#define ENF_GAME_SIM_TEXT_H

#include <enfilade/base.h>

/** What is left of a text. */
typedef struct SimText {
    const char *at, *end;
} SimText;

/** Takes the next line, without its end (\n or \r\n); false at the end of the text. */
bool sim_text_line(SimText *text, SimText *line);
/** Takes the next word: what stands between blanks, or before `comma` if that is not 0 (words may then be empty). Empty, and false,
 *  at the end of the line or if the word does not fit. */
bool sim_text_word(SimText *line, char comma, char *word, size_t size);
/** All of `word` as a decimal number: sign, digits, point, digits; at most 1e9 in size. False, and *value untouched, if it is none. */
bool sim_text_number(const char *word, double *value);

#endif
