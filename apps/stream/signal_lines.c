#include "signal_lines.h"

#include "messages.h"

static const int64_t retry_interval_ns = INT64_C(3000000000);

static void tell_failure(signal_lines *lines, const char *name, const error_text *reason)
{
    lines->failures++;
    lines->next_try_ns = camera_clock_ns() + retry_interval_ns;
    message_tell(name, reason->text);
}

static gpio_output *open_output(signal_lines *lines, const char *title, const char *name)
{
    error_text reason;
    if (name[0] == '\0')
        return NULL;
    gpio_output *line = gpio_output_open(name, &reason);
    if (line == NULL)
        tell_failure(lines, title, &reason);
    return line;
}

void signal_lines_open(signal_lines *lines, const gpio_settings *wanted)
{
    error_text reason;
    signal_lines_close(lines);
    lines->seen = open_output(lines, "gpio-seen", wanted->seen);
    gpio_output *flash = open_output(lines, "gpio-strobe", wanted->strobe);
    if (flash != NULL && (lines->strobe = strobe_open(flash, &reason)) == NULL)
        tell_failure(lines, "gpio-strobe", &reason);
    if (wanted->trigger[0] != '\0' && (lines->trigger = gpio_input_open(wanted->trigger, &reason)) == NULL)
        tell_failure(lines, "gpio-trigger", &reason);
}

bool signal_lines_are_whole(const signal_lines *lines, const gpio_settings *wanted)
{
    return (lines->seen != NULL) == (wanted->seen[0] != '\0') &&
           (lines->strobe != NULL) == (wanted->strobe[0] != '\0') &&
           (lines->trigger != NULL) == (wanted->trigger[0] != '\0');
}

static void tell_return(const char *title, const char *name)
{
    error_text text;
    error_text_set(&text, "GPIO line %s is there", name);
    message_tell(title, text.text);
}

void signal_lines_try_again(signal_lines *lines, const gpio_settings *wanted, int64_t now_ns)
{
    error_text known;
    gpio_output *flash = NULL;
    if (now_ns < lines->next_try_ns || signal_lines_are_whole(lines, wanted))
        return;
    lines->next_try_ns = now_ns + retry_interval_ns;
    if (lines->seen == NULL && wanted->seen[0] != '\0' &&
        (lines->seen = gpio_output_open(wanted->seen, &known)) != NULL)
        tell_return("gpio-seen", wanted->seen);
    if (lines->strobe == NULL && wanted->strobe[0] != '\0' &&
        (flash = gpio_output_open(wanted->strobe, &known)) != NULL &&
        (lines->strobe = strobe_open(flash, &known)) != NULL)
        tell_return("gpio-strobe", wanted->strobe);
    if (lines->trigger == NULL && wanted->trigger[0] != '\0' &&
        (lines->trigger = gpio_input_open(wanted->trigger, &known)) != NULL)
        tell_return("gpio-trigger", wanted->trigger);
}

void signal_lines_show_seen(signal_lines *lines, bool seen)
{
    error_text reason;
    if (lines->seen == NULL || gpio_output_set(lines->seen, seen, &reason))
        return;
    tell_failure(lines, "gpio-seen", &reason);
    gpio_output_close(lines->seen);
    lines->seen = NULL;
}

static bool strobe_is_there(signal_lines *lines)
{
    error_text reason;
    if (lines->strobe == NULL || !strobe_news(lines->strobe, &reason))
        return lines->strobe != NULL;
    tell_failure(lines, "gpio-strobe", &reason);
    strobe_close(lines->strobe);
    lines->strobe = NULL;
    return false;
}

void signal_lines_foretell(signal_lines *lines, const camera_frame *got, int64_t now_ns)
{
    /* Light needs time to come on, and so does the thread that turns it on. */
    const int64_t lead_ns = 300000;
    if (!strobe_is_there(lines) || got->image.time_ns == FRAME_TIME_UNKNOWN)
        return;
    if (lines->last_exposure_ns != 0)
        lines->period_ns = (got->image.time_ns - lines->last_exposure_ns) / ((int64_t)got->dropped + 1);
    lines->last_exposure_ns = got->image.time_ns;
    if (lines->period_ns <= 0)
        return;
    int64_t half_ns = got->exposure_us > 0 ? (int64_t)got->exposure_us * 500 : lines->period_ns / 4;
    int64_t periods = (now_ns + lead_ns + half_ns - got->image.time_ns) / lines->period_ns + 1;
    int64_t middle_ns = got->image.time_ns + periods * lines->period_ns;
    const strobe_times times = {middle_ns - half_ns - lead_ns, middle_ns + half_ns, lines->period_ns};
    strobe_plan(lines->strobe, &times);
}

bool signal_lines_triggered(signal_lines *lines)
{
    error_text reason;
    unsigned count = 0;
    if (lines->trigger == NULL || gpio_input_events(lines->trigger, &count, &reason))
        return count > 0;
    tell_failure(lines, "gpio-trigger", &reason);
    gpio_input_close(lines->trigger);
    lines->trigger = NULL;
    return false;
}

int signal_lines_descriptor(const signal_lines *lines)
{
    return lines->trigger != NULL ? gpio_input_descriptor(lines->trigger) : -1;
}

void signal_lines_close(signal_lines *lines)
{
    gpio_output_close(lines->seen);
    gpio_input_close(lines->trigger);
    strobe_close(lines->strobe);
    *lines = (signal_lines){.failures = lines->failures};
}
