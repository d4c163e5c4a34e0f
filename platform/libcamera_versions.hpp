/*
 * libcamera changes its interface with each 0.x. What differs between those that we build with stands here; what
 * could be written so that all take it (initializer lists for roles, auto for planes and strings) stands where it is
 * used. It was compiled with 0.0.3 (Debian 12), 0.3.2, 0.4.0 and 0.7.1, and ran with 0.0.3.
 */
#ifndef PLATFORM_LIBCAMERA_VERSIONS_HPP
#define PLATFORM_LIBCAMERA_VERSIONS_HPP

#include <libcamera/libcamera.h>
#include <libcamera/version.h>

#include <cstdint>

#define LIBCAMERA_IS_AT_LEAST(major, minor) \
    (LIBCAMERA_VERSION_MAJOR > (major) ||   \
     (LIBCAMERA_VERSION_MAJOR == (major) && LIBCAMERA_VERSION_MINOR >= (minor)))

/* Adds what makes exposure and gain those given; 0 leaves them to the camera. Only controls that the camera has are
 * added: others would be refused together with the rest. */
inline void libcamera_set_light(libcamera::ControlList &list, const libcamera::ControlInfoMap &known,
                                int32_t exposure_us, float gain)
{
    namespace controls = libcamera::controls;
    const auto has = [&known](const libcamera::ControlId &id) { return known.find(&id) != known.end(); };

#if LIBCAMERA_IS_AT_LEAST(0, 5)
    /* A value counts only where its mode is manual, and 0 no longer means automatic. */
    if (has(controls::ExposureTimeMode))
        list.set(controls::ExposureTimeMode, static_cast<int32_t>(exposure_us > 0 ? controls::ExposureTimeModeManual
                                                                                  : controls::ExposureTimeModeAuto));
    if (has(controls::AnalogueGainMode))
        list.set(controls::AnalogueGainMode, static_cast<int32_t>(gain > 0 ? controls::AnalogueGainModeManual
                                                                           : controls::AnalogueGainModeAuto));
    if (exposure_us > 0 && has(controls::ExposureTime))
        list.set(controls::ExposureTime, exposure_us);
    if (gain > 0 && has(controls::AnalogueGain))
        list.set(controls::AnalogueGain, gain);
#else
    /* While AeEnable is on, a value that is not 0 is held and the other one found. */
    if (has(controls::AeEnable))
        list.set(controls::AeEnable, exposure_us == 0 || gain == 0);
    if (has(controls::ExposureTime) && (exposure_us > 0 || has(controls::AeEnable)))
        list.set(controls::ExposureTime, exposure_us);
    if (has(controls::AnalogueGain) && (gain > 0 || has(controls::AeEnable)))
        list.set(controls::AnalogueGain, gain);
#endif
}

#endif
