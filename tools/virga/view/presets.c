/* presets.c - the presets and their settings. '*' stands for every pane or wiper. */
#include "view/presets.h"

static const view_preset presets[] = {
    {"drizzle",
     "Drizzle",
     "fine drops that hang in the air; wipers now and then",
     {"rain.rate_mm_h=0.7", "rain.sizes=best", "rain.wind_m_s=[0.6, 0, 0.2]", "rain.gust_m_s=0.3", "rain.gust_time_s=6",
      "rain.streak_gain=6", "rain.haze=1.5", "glass.*.mist_max_mm=0.35", "glass.*.kind=clean",
      "glass.*.wipers.*.drive=intermittent", "glass.*.wipers.*.sweep_s=0.9", "glass.*.wipers.*.pause_s=6"}},
    {"shower",
     "Shower",
     "large drops out of a light wind",
     {"rain.rate_mm_h=15", "rain.sizes=marshall-palmer", "rain.wind_m_s=[1.5, 0, 0.5]", "rain.gust_m_s=1",
      "rain.gust_time_s=4", "rain.streak_gain=3", "rain.haze=1", "glass.*.mist_max_mm=0.6", "glass.*.kind=clean",
      "glass.*.wipers.*.drive=intermittent", "glass.*.wipers.*.sweep_s=0.7", "glass.*.wipers.*.pause_s=2"}},
    {"storm",
     "Storm",
     "slanted rain in gusts, wipers without a pause",
     {"rain.rate_mm_h=70", "rain.sizes=marshall-palmer", "rain.wind_m_s=[2.5, 0, 4.5]", "rain.gust_m_s=2",
      "rain.gust_time_s=3", "rain.streak_gain=3", "rain.haze=1", "splash.gain=2", "glass.*.mist_max_mm=0.6",
      "glass.*.kind=clean", "glass.*.wipers.*.drive=continuous", "glass.*.wipers.*.sweep_s=0.55"}},
    {"carwash",
     "Car wash",
     "water from above as dense as it comes, on glass that drops run off",
     {"rain.rate_mm_h=200", "rain.sizes=best", "rain.wind_m_s=[0, 0, 0]", "rain.gust_m_s=1", "rain.gust_time_s=0.8",
      "rain.streak_gain=2", "rain.haze=0.6", "splash.gain=2", "glass.*.mist_max_mm=0.2", "glass.*.kind=coated",
      "glass.*.wipers.*.drive=parked"}},
    {"window",
     "Window at night",
     "lamps behind slow drops on a dirty pane",
     {"rain.rate_mm_h=8", "rain.sizes=marshall-palmer", "rain.wind_m_s=[0.8, 0, 0.3]", "rain.gust_m_s=0.6",
      "rain.gust_time_s=5", "rain.streak_gain=2", "rain.light_gain=4", "rain.haze=1", "environment.intensity=0.12",
      "preview.exposure_ev=1.5", "splash.light_gain=3", "glass.*.kind=dirty", "glass.*.mist_max_mm=0.4",
      "glass.*.wipers.*.drive=parked"}},
};

const view_preset *view_presets(size_t *count)
{
    *count = sizeof presets / sizeof presets[0];
    return presets;
}
