/*
 * Tapemark: reads tape-shaped fiducial markers in 8-bit gray images.
 *
 * The whole library promises: no heap, no mutable globals, no I/O, no recursion, no dependency beyond mem* functions
 * (and, on processors without such an instruction, sqrtf); stack frames below 2 KiB; work bounded by a budget the
 * caller may set. Every function is reentrant: two threads may decode at once, each with its own workspace and
 * result.
 *
 * A first decode, with everything static:
 *
 *     static uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(640, 480)];
 *     static tapemark_cm cms[32];
 *     static tapemark_tm tms[8];
 *
 *     tapemark_image image = {pixels, 640, 480, 640};
 *     tapemark_result result = {.cms = cms, .cm_capacity = 32, .tms = tms, .tm_capacity = 8};
 *     if (tapemark_decode(&image, NULL, workspace, sizeof workspace, &result) == TAPEMARK_OK)
 *         for (size_t i = 0; i < result.cm_count; i++)
 *             use(cms[i].id, cms[i].corners);
 *
 * Terms. A code marker (CM) is 32 x 7 modules: two finder patterns with a coding region of 7 x 16 cells
 * between them. A tape marker (TM) is a segment of three or more CMs between two groups of four bars.
 * Image coordinates are in pixels, x to the right, y down; (0, 0) is the centre of the first pixel.
 */
#ifndef TAPEMARK_H
#define TAPEMARK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TAPEMARK_VERSION_MAJOR 0
#define TAPEMARK_VERSION_MINOR 1
#define TAPEMARK_VERSION_PATCH 0

/* The version of the library linked in, for instance "0.1.0". Static storage; never NULL. */
const char *tapemark_version(void);

/* ---- Answers ----------------------------------------------------------------------------------------- */

/* Answers of zero or more leave a valid result; negative ones mean that the call itself was wrong and that
 * nothing was read or written beyond the result's counts and statistics. */
typedef enum tapemark_status {
    TAPEMARK_OK = 0,             /* done; from tapemark_decode: at least one marker was read */
    TAPEMARK_NOTHING_FOUND = 1,  /* the whole image was looked at, and no marker was read */
    TAPEMARK_NO_ROOM = 2,        /* more markers were read than the caller's arrays hold; those are full */
    TAPEMARK_UNFINISHED = 3,     /* nothing was read, but a limit was hit first (see tapemark_stats.limits) */
    TAPEMARK_AMBIGUOUS = 4,      /* more than one place on the map fits */
    TAPEMARK_BAD_CALL = -1,      /* NULL, a size of zero, a stride below the width, an id out of range, … */
    TAPEMARK_BAD_CONFIG = -2,    /* a field of tapemark_config is out of its range */
    TAPEMARK_BAD_WORKSPACE = -3, /* the workspace is NULL or smaller than tapemark_workspace_bytes() */
    TAPEMARK_BAD_MAP = -4        /* an entry of the map is out of order or out of its range */
} tapemark_status;

/* A short English phrase for a status. Static storage; never NULL, also for values not listed above. */
const char *tapemark_status_text(tapemark_status status);

/* ---- Code words, ids and printed cells ----------------------------------------------------------------- */

enum {
    TAPEMARK_DATA_BITS = 78,      /* bits of a code word */
    TAPEMARK_WORD_BYTES = 10,     /* the same, packed */
    TAPEMARK_MAX_ONES = 4,        /* ids use code words of up to four ones (or, when negative, zeros) */
    TAPEMARK_MAX_ID = 1505582,    /* 1 + 78 + 3003 + 76076 + 1426425 code words, less one */
    TAPEMARK_CELL_ROWS = 7,
    TAPEMARK_CELL_COLUMNS = 16,
    TAPEMARK_CELLS = 112,
    TAPEMARK_CM_WIDTH_MODULES = 32,
    TAPEMARK_CM_PITCH_MODULES = 25,  /* from one CM of a segment to the next: they share a finder pattern */
    TAPEMARK_HEIGHT_MODULES = 7,
    TAPEMARK_BAR_MODULES = 8,        /* what the bars add to a segment at each end: four bars, four gaps */
    TAPEMARK_TM_MIN_CMS = 3,
    TAPEMARK_TM_MAX_CMS = 32         /* longest TM the decoder reads */
};

/* 78 bits, the first printed bit in the most significant bit of the first byte; the last two bits are 0. */
typedef struct tapemark_word {
    uint8_t bytes[TAPEMARK_WORD_BYTES];
} tapemark_word;

/* Bit `index` of a word, 0 (printed first) to 77; false for any other index. */
bool tapemark_word_bit(const tapemark_word *word, unsigned index);

/* The code word of an id from -TAPEMARK_MAX_ID to TAPEMARK_MAX_ID; else TAPEMARK_BAD_CALL, `word` untouched. */
tapemark_status tapemark_word_from_id(int32_t id, tapemark_word *word);

/* The id of a code word with at most four ones (id >= 0) or at most four zeros (id <= -1).
 * TAPEMARK_NOTHING_FOUND, `id` untouched, when the word belongs to no id: any other number of ones, or all
 * ones (there is no -0). */
tapemark_status tapemark_id_from_word(const tapemark_word *word, int32_t *id);

/* All 78 bits inverted: the word of -id for the word of id. */
tapemark_word tapemark_word_complement(const tapemark_word *word);

/* BLAKE2b (RFC 7693) with a one-byte digest and no key over the 78 ASCII characters '0' and '1'. */
uint8_t tapemark_word_checksum(const tapemark_word *word);

/* The 7 x 16 cells of a CM as printed, seen upright: rows[0] is the top row, bit 15 its first column, 1 is
 * dark. TAPEMARK_BAD_CALL, `rows` untouched, for an id out of range. */
tapemark_status tapemark_cm_grid(int32_t id, uint16_t rows[TAPEMARK_CELL_ROWS]);

/* Width in modules of a printed segment of `cm_count` CMs, without the quiet zone: 25 n + 7, and 16 more with
 * bars. 0 for no CMs or more than 65535. Its height is TAPEMARK_HEIGHT_MODULES. */
size_t tapemark_segment_width_modules(size_t cm_count, bool with_bars);

/* Draws a segment, one byte a module, 1 is dark, row by row from the top left: 7 rows of
 * tapemark_segment_width_modules() bytes each, without the quiet zone.
 * TAPEMARK_NO_ROOM, nothing written, when modules_size is too small; TAPEMARK_BAD_CALL for an id out of range
 * or no ids. */
tapemark_status tapemark_segment_draw(const int32_t *ids, size_t cm_count, bool with_bars,
                                      uint8_t *modules, size_t modules_size);

/* ---- Decoding: input ---------------------------------------------------------------------------------- */

/* A view of an 8-bit gray image; never written to. Both sides are 1 to 65535 px, stride_bytes >= width_px. */
typedef struct tapemark_image {
    const uint8_t *pixels;
    int32_t width_px;
    int32_t height_px;
    ptrdiff_t stride_bytes;
} tapemark_image;

typedef enum tapemark_polarity {
    TAPEMARK_DARK_ON_LIGHT = 0,
    TAPEMARK_LIGHT_ON_DARK = 1  /* the whole tape is seen inverted: light ink, or a negative image */
} tapemark_polarity;

/* A zeroed configuration (or a NULL pointer to one) is the default. */
typedef struct tapemark_config {
    /* Least share of scan lines that must agree on a TM's code, above 0.5 and up to 1. 0: 0.7. */
    float vote_min;
    /* Whether roll_deg says how tapes lie in the image. Used only where the marker itself cannot tell which
     * way is up: cells too small to be resolved. */
    bool roll_known;
    /* Direction in which upright tapes read, clockwise from the image's x axis, -360 to 360. 0: to the right. */
    float roll_deg;
    tapemark_polarity polarity;
    /* Least difference between light and dark, in gray levels, 1 to 255. 0: 5. */
    uint8_t contrast_min;
    /* Least confidence of a reported CM, 0 to 1. 0: the built-in rule alone decides. */
    float confidence_min;
    /* Largest |id| in use; no other id is reported. 0: TAPEMARK_MAX_ID. */
    int32_t id_max;
    /* The ids that are in use, in ascending order without repetition, which each call checks; borrowed for the
     * call. Where given, no other id is reported, and theirs are surer: nothing else competes with them.
     * NULL with count 0: every id up to id_max. */
    const int32_t *known_ids;
    size_t known_id_count;
    /* Work allowed after the first pass over the image, in pixel reads (of some 100 instructions, all told). It
     * bounds the time of the worst frame: what is underway when it is spent, a CM or a TM, is ended. Each of the
     * first 20 finder patterns with another one in a CM's distance adds 1500, and each CM that was read 2500, so
     * that it is work in vain that counts. 0: tapemark_default_work_budget(). */
    uint32_t work_budget;
} tapemark_config;

/* The work budget used for an image of this size when the configuration has none. 0 for sizes out of range. */
uint32_t tapemark_default_work_budget(int32_t width_px, int32_t height_px);

/* ---- Decoding: output --------------------------------------------------------------------------------- */

typedef struct tapemark_point {
    float x_px;
    float y_px;
} tapemark_point;

/* Corners go top left, top right, bottom right, bottom left in the marker's own upright frame. A CM is believed for
 * itself, when none of its cells contradicts its word; or as one of a segment whose ids ascend by one (their signs
 * left aside), with up to a tenth of its cells wrong. */
typedef struct tapemark_cm {
    int32_t id;
    tapemark_word word;
    tapemark_point corners[4];  /* of the 32 x 7 modules, outer edges of the ink */
    float confidence;           /* 0 to 1 */
    uint8_t doubtful_cells;     /* of 112: nearer to the middle between light and dark than to either */
    uint8_t corrected_cells;    /* of 112: on the wrong side of that middle for the word that was read */
    int16_t tm;                 /* index in the result's tms of the TM it belongs to, or -1 */
    int16_t slot;               /* its place in that TM as read, from 0; -1 without a TM */
} tapemark_cm;

/* A code has no checksum: where none of its CMs could be read, another plan's tape may show it, or, rarely, one with
 * something before a CM. */
typedef struct tapemark_tm {
    char code[TAPEMARK_TM_MAX_CMS + 1];  /* '1' for a light CM, '0' for a dark one, NUL at the end */
    uint8_t length;                      /* number of CMs, 3 to TAPEMARK_TM_MAX_CMS */
    uint8_t unknown_cms;                 /* CMs in it read as ids that are not to be: another plan's tape? */
    bool directed;                       /* false: it may as well read backwards; corners follow the code */
    float vote;                          /* share of the scan lines that agree with the code, 0 to 1 */
    float confidence;                    /* 0 to 1 */
    tapemark_point corners[4];           /* of the ink, bars included */
} tapemark_tm;

/* A finder pattern that was located, for pictures of what the decoder saw. */
typedef struct tapemark_finder {
    tapemark_point centre;
    tapemark_point along;   /* one module along one of its sides, as a vector; whether that side lies along */
    tapemark_point across;  /* the tape, the pattern itself does not tell; and one module along the other side */
    float score;            /* correlation with the ideal pattern, -1 to 1 */
} tapemark_finder;

/* Why something that looked like a marker was not reported. */
typedef enum tapemark_reject {
    TAPEMARK_REJECT_SHAPE,       /* finder pattern: rings missing around it, or no square's shape */
    TAPEMARK_REJECT_LONE,        /* finder pattern: no other one at the distance of a CM */
    TAPEMARK_REJECT_ALIGNMENT,   /* CM: which way is up does not stand out, or it leaves the image */
    TAPEMARK_REJECT_SCORE,       /* CM: no code word fits well enough, or with too little confidence */
    TAPEMARK_REJECT_MARGIN,      /* CM: two code words fit about as well */
    TAPEMARK_REJECT_UNKNOWN_ID,  /* CM: the word read is not among the known ids, or beyond id_max */
    TAPEMARK_REJECT_CONFLICT,    /* CM or TM: it and the CMs of its segment contradict each other */
    TAPEMARK_REJECT_BARS,        /* TM: bars missing at an end (cut by the border, covered, or no TM) */
    TAPEMARK_REJECT_VOTE,        /* TM: too few scan lines agree */
    TAPEMARK_REJECT_COUNT
} tapemark_reject;

/* Bits of tapemark_stats.limits: each names a bound that cut the work short in this frame. */
enum {
    TAPEMARK_LIMIT_SCAN = 1,        /* too much texture: scan lines spread further apart, weakest parts left out */
    TAPEMARK_LIMIT_WORK = 2,        /* the work budget was spent */
    TAPEMARK_LIMIT_CANDIDATES = 4,  /* more finder patterns, or more of what far tapes are found by, than the
                                     * workspace holds */
    TAPEMARK_LIMIT_CMS = 8,         /* more CMs than result.cm_capacity */
    TAPEMARK_LIMIT_TMS = 16,        /* more TMs than result.tm_capacity */
    TAPEMARK_LIMIT_LENGTH = 32      /* a segment went on beyond TAPEMARK_TM_MAX_CMS */
};

typedef struct tapemark_stats {
    uint32_t limits;
    uint32_t work;               /* pixel reads after the first pass */
    uint32_t tiles;              /* tiles of the image, and those with enough contrast to be scanned */
    uint32_t tiles_active;
    uint32_t pattern_hits;       /* places where a scan line showed 1:1:3:1:1 */
    uint32_t finders_tried;      /* of those, the distinct ones that were looked at in both directions */
    uint32_t finders;            /* finder patterns located */
    uint32_t segments;           /* rows of two or more of them, and rows of far tapes found as a whole */
    uint32_t cms_tried;          /* pairs of neighbours looked at as a CM */
    uint32_t cms_read;           /* of those, CMs that were believed, whether or not there was room for them */
    uint32_t rejects[TAPEMARK_REJECT_COUNT];
} tapemark_stats;

/* The caller owns the arrays; capacities may be 0 (with a NULL pointer) for kinds that are not wanted: that is no
 * lack of room. Without room for TMs, CMs have no tm and slot. Finders beyond their capacity are left out silently.
 * A call sets the counts and `stats` and leaves entries beyond the counts undefined. */
typedef struct tapemark_result {
    tapemark_cm *cms;
    size_t cm_capacity;
    size_t cm_count;
    tapemark_tm *tms;
    size_t tm_capacity;
    size_t tm_count;
    tapemark_finder *finders;
    size_t finder_capacity;
    size_t finder_count;
    tapemark_stats stats;
} tapemark_result;

/* ---- Decoding ----------------------------------------------------------------------------------------- */

/* Bytes of workspace for images of this size, for static arrays: at most 24 KiB for 640 x 480 and 64 KiB for
 * 1920 x 1080 px. Any alignment will do. */
#define TAPEMARK_TILE_PX 16
#define TAPEMARK_WORKSPACE_FIXED_BYTES 18432
#define TAPEMARK_TILES(pixels) (((size_t)(pixels) + TAPEMARK_TILE_PX - 1) / TAPEMARK_TILE_PX)
#define TAPEMARK_WORKSPACE_BYTES(width_px, height_px)                                                  \
    ((size_t)TAPEMARK_WORKSPACE_FIXED_BYTES +                                                          \
     3 * (TAPEMARK_TILES(width_px) + 2) * (TAPEMARK_TILES(height_px) + 2) +                            \
     4 * TAPEMARK_TILES(height_px) * ((TAPEMARK_TILES(width_px) + 31) / 32) +                          \
     4 * TAPEMARK_TILES(width_px) * ((TAPEMARK_TILES(height_px) + 31) / 32))

/* The same, checked: 0 for a width or height outside 1 to 65535. */
size_t tapemark_workspace_bytes(int32_t width_px, int32_t height_px);

/* Reads all markers in an image.
 *
 * config may be NULL. workspace holds at least tapemark_workspace_bytes(width, height) bytes; its content
 * does not matter before the call, means nothing after it and may be used for other things between calls.
 * result's pointers and capacities must be set; see tapemark_result for what is written.
 *
 * A limit that was hit is not an error: what was read stands, and stats.limits names the limit. */
tapemark_status tapemark_decode(const tapemark_image *image, const tapemark_config *config,
                                void *workspace, size_t workspace_size, tapemark_result *result);

/* ---- Places on a plan ---------------------------------------------------------------------------------- */

/* A plan is seen from above: x to the right, y down, in metres. Directions are those in which a marker reads.
 *
 * A map is a table that the caller owns and that is never written to: it may stand in flash.
 *
 *     static const int32_t ids[] = {-2, -1, 0, 3};
 *     static const tapemark_map_cm cms[] = {
 *         {2.43f, 0.11f, 1, 0, 0, 2}, {2.21f, 0.11f, 1, 0, 0, 1}, {2, 0.11f, 1, 0, 0, 0},
 *         {3.5f, 0.2f, 0, 0, -1, -1}};
 *     static const tapemark_map_tm tms[] = {{4, 3, true, 2.21f, 0.11f, 1, 0}};
 *     static const tapemark_map map = {ids, cms, 4, tms, 1};
 *
 * A CM takes 28 bytes and a TM 32, so that 100 000 CMs fit into 4 MB, even in TMs of three. Float holds places up to
 * 2 km from the origin to 0.1 mm. */

enum { TAPEMARK_MAP_CODE_MAX = 64 };

typedef struct tapemark_map_cm {
    float x_m, y_m;  /* of its centre */
    float dx, dy;    /* the direction in which it reads, a vector of length 1; 0, 0: unknown */
    int32_t tm;      /* index among the map's tms; -1: it stands alone */
    int16_t slot;    /* its place in that TM, from 0; -1: unknown, or it stands alone */
} tapemark_map_cm;

typedef struct tapemark_map_tm {
    uint64_t code;   /* read as a binary number: 4 for 100 */
    uint8_t length;  /* number of CMs, TAPEMARK_TM_MIN_CMS to TAPEMARK_MAP_CODE_MAX */
    bool placed;     /* whether its place is known */
    float x_m, y_m;  /* of its middle */
    float dx, dy;    /* as above */
} tapemark_map_tm;

/* The ids may serve as tapemark_config.known_ids as they are. */
typedef struct tapemark_map {
    const int32_t *ids;          /* ascending, without repetition */
    const tapemark_map_cm *cms;  /* in the order of their ids */
    size_t cm_count;
    const tapemark_map_tm *tms;  /* ascending by length, among equals by code; codes may repeat */
    size_t tm_count;
} tapemark_map;

/* Looks at a whole map once; the calls below rely on what this finds in order, but touch no memory outside of the
 * table whatever it holds. TAPEMARK_BAD_MAP: `index`, which may be NULL, is set to that of the first bad CM, or to
 * cm_count plus that of the first bad TM; TMs are looked at first. */
tapemark_status tapemark_map_check(const tapemark_map *map, size_t *index);

/* The index of a CM; TAPEMARK_NOTHING_FOUND, `index` untouched, for an id that is not on the map. */
tapemark_status tapemark_map_find_cm(const tapemark_map *map, int32_t id, size_t *index);

/* The index of the only TM with a code of '0' and '1'. Where it is not known which way the code was read
 * (tapemark_tm.directed), it may also be there backwards. TAPEMARK_NOTHING_FOUND or TAPEMARK_AMBIGUOUS, `index`
 * untouched, when none or several fit. */
tapemark_status tapemark_map_find_tm(const tapemark_map *map, const char *code, bool directed, size_t *index);

/* What the map says to a TM and the CMs that were read in it. */
typedef enum tapemark_agreement {
    TAPEMARK_AGREES,            /* the CMs are those that the map has in these places of this TM */
    TAPEMARK_CODE_ALONE,        /* no CM could be read in it; one TM of the map has its code */
    TAPEMARK_CODE_AMBIGUOUS,    /* no CM was read in it; several TMs of the map have its code */
    TAPEMARK_CODE_UNKNOWN,      /* no CM was read in it; no TM of the map has its code */
    TAPEMARK_CODE_OF_OTHER_TM,  /* the map has another code for the TM of its CMs */
    TAPEMARK_CM_UNKNOWN,        /* a CM in it is not on the map, or the TM has unknown_cms */
    TAPEMARK_CM_WITHOUT_TM,     /* a CM in it stands alone on the map */
    TAPEMARK_CMS_OF_SEVERAL_TMS,
    TAPEMARK_CM_IN_OTHER_SLOT,
    TAPEMARK_RUNS_BACKWARDS     /* the map has it the other way round, though its direction was read */
} tapemark_agreement;

typedef struct tapemark_tm_place {
    tapemark_agreement agreement;
    int32_t tm;      /* index among the map's tms when they agree, or the code alone tells; else -1 */
    bool backwards;  /* the corners that were read run against the map's direction: it was read undirected */
} tapemark_tm_place;

/* Where a TM that was read hangs: TAPEMARK_OK when place->tm is set, else TAPEMARK_NOTHING_FOUND or
 * TAPEMARK_AMBIGUOUS; place->agreement says why. */
tapemark_status tapemark_map_locate_tm(const tapemark_map *map, const tapemark_result *result, size_t tm_index,
                                       tapemark_tm_place *place);

#ifdef __cplusplus
}
#endif

#endif
