/* How often our own code asked for memory: a warm frame must not. */
#ifndef GAME_FRONT_HEAP_H
#define GAME_FRONT_HEAP_H

/** Calls of malloc, calloc and realloc since the start; 0 in builds that do not count. */
unsigned long heap_calls(void);
/** Bytes that those calls gave and that were not yet freed; what others gave and we freed counts against them. */
long long heap_live(void);

#endif
