/* How many wrong ids are read in a million pairs of finder patterns between which there is no code marker? Makes such
 * pairs, of each kind, alone and in rows, in several sizes, decodes them without a map and with one, and counts. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "forged_sheet.h"
#include "option_values.h"

#define PROGRAM "forged_pairs"
#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

enum { EXIT_WRONG = 1, EXIT_BAD_USAGE = 2, CMS_MAX = 2 * FORGED_PAIRS_MAX, CENTS = 101, MAP_IDS = 200, ROW_CMS = 6 };

/* Readings with less confidence than this, in hundredths, are flagged by it. */
enum { SURE = 65 };

static const char usage[] =
    "usage: forged_pairs [OPTION...]\n"
    "Counts the wrong ids read in pairs of finder patterns a code marker apart with anything else between them.\n"
    "Cells that happen to be the print of an id, and are read as that, are counted apart (printed).\n"
    "\n"
    "  --pairs N         of each kind, size and layout (1000)\n"
    "  --seed N          of all that is random (1)\n"
    "  --px NUMBER,...   pixels a module, up to eight sizes (1.3,2,3,5)\n"
    "  --most N          fails when more than N pairs of a million read wrong with a confidence of 0.65 or more\n"
    "  --keep DIR        writes frames in which something was read wrong, without a map, to DIR, a few of each line\n"
    "  --help            prints this\n";

enum { SIZES_MAX = 8, KEPT_OF_LINE = 3 };

typedef struct settings {
    double pairs, seed, most;
    double sizes[SIZES_MAX];
    size_t size_count;
    const char *keep;
} settings;

/* What was read of the pairs of one kind, size and layout. */
typedef struct tally {
    unsigned looked_at;     /* pairs that the decoder took for a candidate */
    unsigned right;         /* the id of the marker in which cells were flipped */
    unsigned printed;       /* another id, but cell for cell the one that is there: no decoder's fault */
    unsigned wrong;
    unsigned by_confidence[CENTS];  /* wrong ones, in hundredths */
} tally;

/* ---- Decoding -------------------------------------------------------------------------------------------- */

static int32_t map_ids[MAP_IDS];

static int by_value(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* As tapes are made: ids in a row, some of them negative. */
static void make_map(void)
{
    random_source source = {1};
    for (int i = 0; i < MAP_IDS; i++)
        map_ids[i] = random_below(&source, 2) ? -i : i;
    qsort(map_ids, MAP_IDS, sizeof map_ids[0], by_value);
}

/* With a budget that no frame of this kind spends: it is what is believed that counts here. */
static bool decode(const forged_sheet *sheet, bool mapped, tapemark_cm *cms, tapemark_result *result)
{
    const size_t size = tapemark_workspace_bytes(sheet->width_px, sheet->height_px);
    void *workspace = malloc(size);
    const tapemark_config config = {.known_ids = mapped ? map_ids : NULL,
                                    .known_id_count = mapped ? MAP_IDS : 0,
                                    .work_budget = UINT32_MAX};
    const tapemark_image image = {sheet->pixels, sheet->width_px, sheet->height_px, sheet->width_px};
    *result = (tapemark_result){.cms = cms, .cm_capacity = CMS_MAX};
    const bool done = workspace && tapemark_decode(&image, &config, workspace, size, result) >= TAPEMARK_OK;
    free(workspace);
    return done;
}

/* Returns how many were wrong. */
static unsigned count(const forged_sheet *sheet, double px_per_module, const tapemark_result *result, tally *sum)
{
    const unsigned before = sum->wrong;
    sum->looked_at += result->stats.cms_tried;
    for (size_t i = 0; i < result->cm_count; i++) {
        const tapemark_cm *cm = &result->cms[i];
        const forged_pair *pair = forged_pair_at(sheet, px_per_module, cm->corners);
        if (pair && (cm->id == pair->id || cm->id == pair->printed)) {
            *(cm->id == pair->id ? &sum->right : &sum->printed) += 1;
            continue;
        }
        sum->wrong++;
        sum->by_confidence[(int)(cm->confidence * (CENTS - 1))]++;
    }
    return sum->wrong - before;
}

static bool keep(const settings *all, const forged_sheet *sheet, const char *line, unsigned number)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s-%u.pgm", all->keep, line, number);
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        return false;
    }
    fprintf(file, "P5\n%d %d\n255\n", (int)sheet->width_px, (int)sheet->height_px);
    fwrite(sheet->pixels, 1, (size_t)sheet->width_px * (size_t)sheet->height_px, file);
    const bool written = !ferror(file);
    return fclose(file) == 0 && written;
}

/* ---- The table --------------------------------------------------------------------------------------------- */

/* Upper end of the 95 % interval, after Wilson. */
static double upper_bound(double count, double of)
{
    const double z = 1.96, share = count / of;
    return (share + z * z / (2 * of) + z * sqrt(share * (1 - share) / of + z * z / (4 * of * of))) / (1 + z * z / of);
}

static unsigned sure_of(const tally *sum)
{
    unsigned sure = 0;
    for (int i = SURE; i < CENTS; i++)
        sure += sum->by_confidence[i];
    return sure;
}

static void print_line(const char *name, const tally *sum, double pairs, bool mapped)
{
    const unsigned sure = sure_of(sum);
    printf("%-24s %-4s %8.0f %8u %8u %8u %7u %7u %9.0f %9.0f\n", name, mapped ? "map" : "-", pairs, sum->looked_at,
           sum->right, sum->printed, sum->wrong, sure, 1e6 * sure / pairs, 1e6 * upper_bound(sure, pairs));
}

static double all_pairs, all_sure;

/* One line of the table without a map, one with it. False when something failed. */
static bool run_line(const settings *all, forgery kind, int row_cms, double px_per_module, uint64_t seed)
{
    static tapemark_cm cms[CMS_MAX];
    char name[64];
    snprintf(name, sizeof name, "%s-%s-%g", forgery_names[kind], row_cms > 1 ? "row" : "alone", px_per_module);
    bool fine = true;
    for (int mapped = 0; mapped < 2; mapped++) {
        const forged_sheet_plan plan = {kind, row_cms, px_per_module, mapped ? map_ids : NULL, MAP_IDS};
        random_source source = {seed};
        tally sum = {0};
        unsigned kept = 0;
        double pairs = 0;
        while (pairs < all->pairs) {
            forged_sheet sheet;
            tapemark_result result;
            if (!forged_sheet_make(&plan, &source, &sheet) || !decode(&sheet, mapped, cms, &result)) {
                fprintf(stderr, PROGRAM ": not enough memory for a frame of %g px a module\n", px_per_module);
                return false;
            }
            pairs += (double)sheet.pair_count;
            if (count(&sheet, px_per_module, &result, &sum) > 0 && all->keep && !mapped && kept < KEPT_OF_LINE)
                fine = keep(all, &sheet, name, kept++) && fine;
            free(sheet.pixels);
        }
        print_line(name, &sum, pairs, mapped);
        all_pairs += pairs;
        all_sure += sure_of(&sum);
    }
    fflush(stdout);
    return fine;
}

static bool run(const settings *all)
{
    bool fine = true;
    printf("%-24s %-4s %8s %8s %8s %8s %7s %7s %9s %9s\n", "pairs", "", "made", "tried", "right", "printed", "wrong",
           "sure", "a million", "at most");
    for (int kind = 0; kind < FORGERY_COUNT; kind++)
        for (int row_cms = 1; row_cms <= ROW_CMS; row_cms += ROW_CMS - 1)
            for (size_t i = 0; i < all->size_count; i++)
                fine = run_line(all, (forgery)kind, row_cms, all->sizes[i],
                                random_at((uint64_t)all->seed, kind, row_cms)) && fine;
    printf("all: %.0f pairs, %.0f wrong and sure, %.0f a million, at most %.0f\n", all_pairs, all_sure,
           1e6 * all_sure / all_pairs, 1e6 * upper_bound(all_sure, all_pairs));
    return fine && 1e6 * all_sure / all_pairs <= all->most;
}

/* ---- The command line ---------------------------------------------------------------------------------------- */

static const struct option known_options[] = {
    {"pairs", required_argument, NULL, 'n'}, {"seed", required_argument, NULL, 's'},
    {"px", required_argument, NULL, 'p'},    {"most", required_argument, NULL, 'm'},
    {"keep", required_argument, NULL, 'k'},  {"help", no_argument, NULL, 'h'},
    {0},
};

static bool take_sizes(settings *all, const char *text, error_text *error)
{
    double sizes[SIZES_MAX] = {0};
    if (!parse_numbers(text, 1, SIZES_MAX, sizes, "pixels a module", error))
        return false;
    for (all->size_count = 0; all->size_count < SIZES_MAX && sizes[all->size_count] != 0; all->size_count++) {
        if (!(sizes[all->size_count] >= 0.5 && sizes[all->size_count] <= 20)) {
            error_text_set(error, "'%.40s' should be sizes from 0.5 to 20", text);
            return false;
        }
        all->sizes[all->size_count] = sizes[all->size_count];
    }
    return all->size_count > 0;
}

static bool take(settings *all, int code, const char *text, error_text *error)
{
    switch (code) {
    case 'n':
        return parse_value(text, (value_range){VALUE_WHOLE, 1, 1e8}, &all->pairs, error);
    case 's':
        return parse_value(text, (value_range){VALUE_WHOLE, 0, 1e15}, &all->seed, error);
    case 'm':
        return parse_value(text, (value_range){VALUE_NUMBER, 0, 1e6}, &all->most, error);
    case 'p':
        return take_sizes(all, text, error);
    default:
        all->keep = text;
        return true;
    }
}

int main(int argc, char *argv[])
{
    settings all = {.pairs = 1000, .seed = 1, .most = 1e6, .sizes = {1.3, 2, 3, 5}, .size_count = 4};
    error_text error;
    for (int code; (code = getopt_long(argc, argv, "", known_options, NULL)) != -1;) {
        if (code == 'h') {
            fputs(usage, stdout);
            return 0;
        }
        if (code == '?')
            return EXIT_BAD_USAGE;
        if (!take(&all, code, optarg, &error)) {
            fprintf(stderr, PROGRAM ": %s: %s\n", argv[optind - 1], error.text);
            return EXIT_BAD_USAGE;
        }
    }
    if (optind < argc) {
        fprintf(stderr, PROGRAM ": unexpected argument '%s'\n", argv[optind]);
        return EXIT_BAD_USAGE;
    }
    make_map();
    return run(&all) ? 0 : EXIT_WRONG;
}
