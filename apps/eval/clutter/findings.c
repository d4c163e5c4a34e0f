#include "findings.h"

#include <time.h>

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

void find_markers(const tapemark_image *image, uint8_t *workspace, size_t workspace_bytes, finding *found)
{
    found->result = (tapemark_result){.cms = found->cms, .cm_capacity = FINDING_CMS_MAX,
                                      .tms = found->tms, .tm_capacity = FINDING_TMS_MAX};
    const double start_ms = now_ms();
    tapemark_decode(image, NULL, workspace, workspace_bytes, &found->result);
    found->decode_ms = now_ms() - start_ms;
}

void kind_findings_add(kind_findings *all, const finding *found)
{
    const tapemark_result *result = &found->result;
    all->frames++;
    all->cms += result->stats.cms_read > result->cm_count ? result->stats.cms_read : result->cm_count;
    all->tms += result->tm_count;
    all->frames_with_finders += result->stats.finders > 0;
    all->frames_with_candidates += result->stats.cms_tried > 0;
    all->decode_ms_sum += found->decode_ms;
    all->decode_ms_max = found->decode_ms > all->decode_ms_max ? found->decode_ms : all->decode_ms_max;
}

void kind_findings_write(FILE *file, const kind_findings *all)
{
    fprintf(file,
            "\"frames\":%zu,\"cms\":%zu,\"tms\":%zu,\"frames_with_finders\":%zu,\"frames_with_candidates\":%zu,"
            "\"decode_ms_mean\":%.3f,\"decode_ms_max\":%.3f",
            all->frames, all->cms, all->tms, all->frames_with_finders, all->frames_with_candidates,
            all->frames > 0 ? all->decode_ms_sum / (double)all->frames : 0, all->decode_ms_max);
}

static void corners_write(FILE *file, const tapemark_point corners[4])
{
    for (int i = 0; i < 4; i++)
        fprintf(file, "%s[%.1f,%.1f]", i > 0 ? "," : "", (double)corners[i].x_px, (double)corners[i].y_px);
}

void finding_write(FILE *file, const finding *found)
{
    fputc('[', file);
    for (size_t i = 0; i < found->result.cm_count; i++) {
        const tapemark_cm *cm = &found->cms[i];
        fprintf(file, "%s{\"type\":\"cm\",\"id\":%d,\"confidence\":%.3f,\"doubtful_cells\":%d,\"corrected_cells\":%d,"
                      "\"corners\":[", i > 0 ? "," : "", (int)cm->id, (double)cm->confidence, cm->doubtful_cells,
                cm->corrected_cells);
        corners_write(file, cm->corners);
        fputs("]}", file);
    }
    for (size_t i = 0; i < found->result.tm_count; i++) {
        const tapemark_tm *tm = &found->tms[i];
        fprintf(file, "%s{\"type\":\"tm\",\"code\":\"%s\",\"confidence\":%.3f,\"vote\":%.3f,\"corners\":[",
                i + found->result.cm_count > 0 ? "," : "", tm->code, (double)tm->confidence, (double)tm->vote);
        corners_write(file, tm->corners);
        fputs("]}", file);
    }
    fputc(']', file);
}
