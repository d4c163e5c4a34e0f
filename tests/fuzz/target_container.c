/* What is known of video files without decoding them: their kind, and whether something is missing at the end. */
#include "content_file.h"
#include "video_container.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    error_text error = {""};
    const video_container kind = video_container_of(bytes, size);
    CLAIM(kind == VIDEO_UNKNOWN || kind == VIDEO_MP4 || kind == VIDEO_RIFF || kind == VIDEO_OTHER);
    const content_file file = content_file_open(bytes, size);
    const content_file piped = content_pipe_open(bytes, size);
    if (video_is_cut_short(file.path, &error))
        CLAIM(error.text[0] != '\0' && (kind == VIDEO_MP4 || kind == VIDEO_RIFF));
    video_is_cut_short(piped.path, &error);
    content_file_close(&file);
    content_file_close(&piped);
    return 0;
}
