"""Writes pvlib_skies.csv, pvlib_planes.csv and pvlib_yields.csv beside itself: skies, and planes that nothing shades.

Made with pvlib 0.16.1 (BSD-3-Clause), its solar positions by the NREL algorithm, sampled over a year at three sites.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import pvlib

SITES = [  # latitude, longitude, height, Linke turbidity, year
    (51.92, 4.48, 0.0, 3.0, 2023),
    (40.01, -105.25, 1650.0, 2.5, 2024),
    (-1.29, 36.82, 1795.0, 4.5, 2021),
]
PLANES = [(0, 0), (20, 180), (35, 135), (60, 250), (90, 180), (90, 0), (120, 90)]  # tilt, azimuth
ALBEDO = 0.2


def sampled(random, latitude, longitude, height, year):
    times = pd.date_range(f"{year}-01-01", f"{year + 1}-01-01", freq="h", tz="UTC")[:-1] + pd.Timedelta(minutes=30)
    sun = pvlib.solarposition.get_solarposition(times, latitude, longitude, altitude=height)
    sun = sun[sun.apparent_zenith < 90]
    some = pd.concat([sun.iloc[random.permutation(len(sun))[:60]], sun[sun.apparent_zenith > 84].iloc[:6]]).sort_index()
    return some[~some.index.duplicated()]


def skies(random, latitude, longitude, height, linke, year):
    sun = sampled(random, latitude, longitude, height, year)
    zenith = sun.apparent_zenith.values
    extra = pvlib.irradiance.get_extra_radiation(sun.index).values
    air_mass = pvlib.atmosphere.get_relative_airmass(zenith)
    pressure = pvlib.atmosphere.alt2pres(height)
    absolute = pvlib.atmosphere.get_absolute_airmass(air_mass, pressure)
    ineichen = pvlib.clearsky.ineichen(zenith, absolute, linke, altitude=height, dni_extra=extra)
    haurwitz = pvlib.clearsky.haurwitz(pd.Series(zenith)).ghi.values
    erbs = pvlib.irradiance.erbs(haurwitz, zenith, sun.index)
    bird = pvlib.clearsky.bird(zenith, air_mass, 0.15, 0.1, 1.5, ozone=0.3, pressure=pressure, dni_extra=extra)
    cloud = random.choice([1.0, 0.8, 0.5, 0.2, 0.0], len(sun))
    dni = np.round(ineichen["dni"] * cloud, 2)
    dhi = np.round(ineichen["dhi"] * (1 + 1.5 * (1 - cloud)), 2)
    ghi = np.round(dni * np.cos(np.radians(zenith)) + dhi, 2)
    return pd.DataFrame(
        {
            "altitude": height,
            "linke": linke,
            "unix_s": [int(t.timestamp()) for t in sun.index],
            "zenith_deg": zenith,
            "azimuth_deg": sun.azimuth.values,
            "extraterrestrial": extra,
            "air_mass": air_mass,
            **{f"ineichen_{k}": ineichen[k] for k in ("ghi", "dni", "dhi")},
            "haurwitz_ghi": haurwitz,
            **{f"erbs_{k}": np.asarray(erbs[k]) for k in ("dni", "dhi")},
            **{f"bird_{k}": bird[k] for k in ("ghi", "dni", "dhi")},
            "ghi": ghi,
            "dni": dni,
            "dhi": dhi,
        }
    )


def planes(number, sky):
    one = lambda values: float(np.atleast_1d(values)[0])  # noqa: E731
    zenith, azimuth = np.array([sky.zenith_deg]), np.array([sky.azimuth_deg])
    dhi, dni, extra = np.array([sky.dhi]), np.array([sky.dni]), np.array([sky.extraterrestrial])
    for tilt, facing in PLANES:
        cosine = pvlib.irradiance.aoi_projection(tilt, facing, zenith, azimuth)
        yield {
            "sky": number,
            "tilt_deg": tilt,
            "azimuth_deg": facing,
            "beam": max(one(sky.dni * cosine), 0.0),
            "isotropic": one(pvlib.irradiance.isotropic(tilt, sky.dhi)),
            "hay_davies": one(pvlib.irradiance.haydavies(tilt, facing, dhi, dni, extra, zenith, azimuth)),
            "perez": one(pvlib.irradiance.perez(tilt, facing, dhi, dni, extra, zenith, azimuth, np.array([sky.air_mass]))),
            "reflected": one(pvlib.irradiance.get_ground_diffuse(tilt, sky.ghi, albedo=ALBEDO)),
        }


def year_of_weather():
    """Hours of a year at Rotterdam under a simple law of sun, clouds, air and wind, which the test repeats."""
    times = pd.date_range("2025-01-01", "2026-01-01", freq="h", tz="UTC")[:-1] + pd.Timedelta(minutes=30)
    day, hour = times.dayofyear.values - 1.0, times.hour.values + 0.5
    season = np.cos(2 * np.pi * (day - 171) / 365)
    height = np.cos(np.pi / 2 * np.clip((hour - 11.7) / (5.9 + 2.2 * season), -1, 1))
    clear = (day * 31 + 17) % 10 / 9
    return pd.DataFrame(
        {
            "dni": 850 * clear * np.sqrt(height),
            "dhi": (60 + 250 * (1 - clear)) * height,
            "air": 10 + 9 * np.cos(2 * np.pi * (day - 199) / 365) + 4 * np.cos(2 * np.pi * (hour - 15) / 24),
            "wind": 3 + 2 * np.sin(0.7 * day),
        },
        index=times,
    )


def yields():
    """A year of PVWatts: 1 kW of panels close to a roof, system losses 11.42 %, an inverter of 1/1.2 kW."""
    latitude, longitude, *_ = SITES[0]
    weather = year_of_weather()
    sun = pvlib.solarposition.get_solarposition(weather.index, latitude, longitude, altitude=0.0)
    zenith, azimuth = sun.apparent_zenith, sun.azimuth
    assert (zenith[(weather.dni > 0) & (weather.dhi > 1)] < 90).all()
    ghi = weather.dni * np.cos(np.radians(zenith)).clip(lower=0) + weather.dhi
    extra = pvlib.irradiance.get_extra_radiation(weather.index)
    close = pvlib.temperature.TEMPERATURE_MODEL_PARAMETERS["sapm"]["close_mount_glass_glass"]
    for model in ("isotropic", "haydavies", "perez"):
        for tilt, facing in PLANES[:-1]:
            plane = pvlib.irradiance.get_total_irradiance(
                tilt, facing, zenith, azimuth, weather.dni, ghi, weather.dhi, dni_extra=extra, albedo=ALBEDO, model=model
            ).fillna(0.0)
            covered = pvlib.iam.physical(pvlib.irradiance.aoi(tilt, facing, zenith, azimuth))
            effective = plane.poa_direct * covered + plane.poa_diffuse
            cell = pvlib.temperature.sapm_cell(plane.poa_global, weather.air, weather.wind, **close)
            direct = pvlib.pvsystem.pvwatts_dc(effective, cell, 1.0, -0.0037) * (1 - 0.1142)
            alternating = pvlib.inverter.pvwatts(direct, 1 / 1.2 / 0.96)
            yield {
                "model": model,
                "tilt_deg": tilt,
                "azimuth_deg": facing,
                "kwh_m2": plane.poa_global.sum() / 1000,
                "dc_kwh": direct.sum(),
                "ac_kwh": alternating.sum(),
                "june_ac_kwh": alternating[weather.index.month == 6].sum(),
            }


if __name__ == "__main__":
    random = np.random.default_rng(20)
    table = pd.concat([skies(random, *site) for site in SITES], ignore_index=True)
    folder = Path(__file__).parent
    table.to_csv(folder / "pvlib_skies.csv", index=False, float_format="%.8g")
    rows = [row for number, sky in table.iterrows() for row in planes(number, sky)]
    pd.DataFrame(rows).to_csv(folder / "pvlib_planes.csv", index=False, float_format="%.8g")
    pd.DataFrame(yields()).to_csv(folder / "pvlib_yields.csv", index=False, float_format="%.8g")
