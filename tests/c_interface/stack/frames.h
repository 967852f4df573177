/* Frames that are made up: a walk, pictures of a hand, blobs and edges anywhere. */

#ifndef FRAMES_H
#define FRAMES_H

#include <sinew.h>

enum { PICTURE_WIDTH = 320, PICTURE_HEIGHT = 240 };

/* Turns the mean pose that stands in `measured` into that of a walker who is seen with noise, hides, turns and stumbles. Its first
 * frame shows nothing. */
void walk(int frame, SinewCyclicFrame *measured);
/* A line of a picture: a hand that moves, a face, a wall. */
void picture_line(int frame, int row, uint16_t line[PICTURE_WIDTH]);
/* Time and shoulders; no lists. */
void frame_of_arms(int frame, SinewArmFrame *arm_frame);
void scatter_candidates(int frame, SinewHandCandidate candidates[SINEW_MAX_CANDIDATES]);
void scatter_edges(int frame, SinewEdgePixel edges[SINEW_MAX_EDGES]);
/* Puts a number that cannot be into a saved state, and its checksum at the end right. */
void break_state(uint32_t *state, size_t bytes);

#endif
