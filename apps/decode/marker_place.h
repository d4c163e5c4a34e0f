/* What a map says of the markers that were read. */
#ifndef DECODE_MARKER_PLACE_H
#define DECODE_MARKER_PLACE_H

#include "tapemark.h"

typedef struct marker_place {
    bool placed;
    double x_m, y_m;
    bool directed;
    double direction_deg;  /* clockwise on the plan from its x axis, 0 to 360 */
} marker_place;

/* `map` may be NULL: nothing is known then. A CM is worth no more than the TM it was read in: where that contradicts
 * the map, it has no place either. */
marker_place marker_place_of_cm(const tapemark_map *map, const tapemark_result *result, size_t index);

/* A TM that contradicts the map has no place. */
marker_place marker_place_of_tm(const tapemark_map *map, const tapemark_result *result, size_t index,
                                tapemark_tm_place *located);

/* In one word what a map says to a TM: "agrees", or
 *
 *     no_cms              no CM was read in it; its code is on the map once
 *     ambiguous_code      no CM was read in it; its code is on the map more than once, or backwards, too
 *     unknown_code        no CM was read in it; its code is not on the map
 *     unknown_cm          a CM in it is not on the map
 *     cm_without_tm       a CM in it stands alone on the map
 *     cms_of_several_tms  its CMs are of several TMs
 *     other_code          its CMs are of a TM with another code
 *     other_slot          its CMs stand in other places of their TM
 *     backwards           its CMs stand in the opposite order, though its direction was read */
const char *agreement_name(tapemark_agreement agreement);

/* The same for people. */
const char *agreement_phrase(tapemark_agreement agreement);

/* Whether a TM and its CMs agree with the map, as in JSON: true, false, or null where there is nothing to compare. */
const char *agreement_answer(tapemark_agreement agreement);

#endif
