#include "listing.h"

#include "camera.h"
#include "gpio_lines.h"
#include "serial_port.h"
#include "text_buffer.h"

/* Names come from devices: nothing in them may reach a terminal as it is. */
typedef struct listing {
    FILE *output;
    const char *title;  /* of what comes next; NULL after the first */
    size_t count;
} listing;

static void write_line(listing *list, const char *name, const char *label)
{
    text_buffer line = {0};
    if (list->count++ == 0)
        fprintf(list->output, "%s\n", list->title);
    text_buffer_add(&line, "  ");
    text_buffer_add_printable(&line, name);
    if (label != NULL && label[0] != '\0') {
        text_buffer_add(&line, "  ");
        text_buffer_add_printable(&line, label);
    }
    if (!line.failed)
        fprintf(list->output, "%s\n", line.text);
    text_buffer_release(&line);
}

static void write_mode(FILE *output, const camera_mode *mode)
{
    fprintf(output, "      %s", camera_mode_format(mode));
    if (mode->width_px > 0)
        fprintf(output, " %dx%d", mode->width_px, mode->height_px);
    if (mode->rate_hz > 0)
        fprintf(output, " %g fps", mode->rate_hz);
    fprintf(output, "\n");
}

static void tell_camera(void *context, const camera_description *description)
{
    listing *list = context;
    write_line(list, description->name, description->label);
    for (size_t i = 0; i < description->mode_count; i++)
        write_mode(list->output, &description->modes[i]);
}

static void tell_port(void *context, const serial_port_description *description)
{
    write_line(context, description->device, description->label);
}

static void tell_chip(void *context, const gpio_chip_description *description)
{
    char label[160];
    snprintf(label, sizeof label, "%.100s, %u lines", description->label, description->line_count);
    write_line(context, description->name, label);
}

static void end_section(const listing *list, const char *none)
{
    if (list->count == 0)
        fprintf(list->output, "%s\n", none);
}

void listing_write(FILE *output)
{
    listing cameras = {output, "cameras (--camera)", 0};
    camera_list(tell_camera, &cameras);
    end_section(&cameras, "no cameras");
    listing ports = {output, "serial ports (--serial)", 0};
    serial_port_list(tell_port, &ports);
    end_section(&ports, "no serial ports");
    listing chips = {output, "GPIO chips (--gpio-seen, --gpio-strobe, --gpio-trigger)", 0};
    gpio_list(tell_chip, &chips);
    end_section(&chips, "no GPIO chips");
}
