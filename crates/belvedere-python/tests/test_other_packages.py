"""Objects of shapely, geopandas, pandas, pvlib and matplotlib are taken, and given, as their users have them."""

from __future__ import annotations

import datetime
import subprocess

import belvedere
import numpy as np
import pytest


@pytest.fixture(scope="module")
def places(standing) -> np.ndarray:
    """Two places on the map."""
    return np.array([standing, np.add(standing, (6.0, 2.0))])


def test_points_of_geopandas_in_any_system_are_the_places_that_their_coordinates_name(scene, places):
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    points = shapely.points(places)
    hours = scene.sun_hours(date="2026-03-21", targets=places)["sun_hours"]
    assert np.isfinite(hours).all()
    in_degrees = geopandas.GeoSeries(points, crs=28992).to_crs(4326)
    for given in (
        points,
        list(points),
        geopandas.GeoSeries(points),
        in_degrees,
        geopandas.GeoDataFrame(geometry=in_degrees),
    ):
        found = scene.sun_hours(date="2026-03-21", targets=given)["sun_hours"]
        np.testing.assert_allclose(found, hours, atol=1e-3)
    seen = scene.viewshed(places, cell=4)
    np.testing.assert_array_equal(scene.viewshed(in_degrees, cell=4).values, seen.values)
    # latitude and longitude in rows: half a metre of the step between the datums
    by_degrees = np.column_stack([in_degrees.y, in_degrees.x])
    seen = scene.isovist(by_degrees)
    assert np.abs(seen.places[:, :2] - places).max() < 0.5
    assert scene.line_of_sight(shapely.Point(places[0]), shapely.Point(places[1])).answer in belvedere.Answer
    with pytest.raises(belvedere.BelvedereError, match="centroid"):
        scene.sun_hours(date="2026-03-21", targets=geopandas.GeoSeries(points).buffer(1))


def test_days_of_pandas_and_numpy_are_days(scene, places):
    pandas = pytest.importorskip("pandas")
    days = pandas.date_range("2026-03-20", periods=2)
    expected = scene.sun_hours(date=["2026-03-20", "2026-03-21"], targets=places)["sun_hours"]
    for given in (days, list(days), days.to_numpy(), [datetime.date(2026, 3, 20), np.datetime64("2026-03-21")]):
        np.testing.assert_array_equal(scene.sun_hours(date=given, targets=places)["sun_hours"], expected)
    with pytest.raises(belvedere.BelvedereError, match="without a time"):
        scene.sun_hours(date=pandas.Timestamp("2026-03-20T10:00"), targets=places)


def test_a_frame_of_weather_gives_the_energy_of_a_file(scene, places, tmp_path):
    pandas = pytest.importorskip("pandas")
    times = pandas.date_range("2025-01-01T00:30", "2025-12-31T23:30", freq="h", tz="Europe/Amsterdam")
    # day is around noon of the sun, 11:38 UTC
    hour = times.tz_convert("UTC").hour.to_numpy() + 0.5
    ghi = np.clip(600 * np.cos(np.pi * (hour - 11.5) / 9), 0, None) * (abs(hour - 11.5) < 5)
    weather = pandas.DataFrame({"ghi": ghi, "dni": 0.8 * ghi, "dhi": 0.4 * ghi}, index=times)
    location = (52.15, 5.39)
    energy = scene.irradiance(weather=weather, location=location, targets=places)["kwh_m2"]
    utc = times.tz_convert("UTC")
    rows = zip(utc, ghi, strict=True)
    lines = [f"{t.year},{t.month},{t.day},{t.hour},{t.minute},{g},{0.8 * g},{0.4 * g}" for t, g in rows]
    file = tmp_path / "weather.csv"
    head = [
        "Source,Latitude,Longitude,Time Zone,Elevation",
        "x,52.15,5.39,0,0",
        "Year,Month,Day,Hour,Minute,GHI,DNI,DHI",
    ]
    file.write_text("\n".join(head + lines) + "\n")
    np.testing.assert_array_equal(energy, scene.irradiance(weather=file, location=location, targets=places)["kwh_m2"])
    assert (energy > 100).all()
    for wrong, said in [
        (dict(weather=weather), "latitude and longitude"),
        (dict(weather=weather.tz_localize(None), location=location), "time zone"),
        (dict(weather=weather[["dni"]], location=location), "ghi"),
    ]:
        with pytest.raises(belvedere.BelvedereError, match=said):
            scene.irradiance(**wrong, targets=places)


def test_a_raster_is_sampled_at_the_cells_that_hold_places(scene, places):
    lit = scene.shadow(sun=(180, 30), cell=1)
    west, south, east, north = lit.bounds
    middles = np.column_stack([lit.x[[0, 5, -1]], lit.y[[0, 7, -1]]])
    np.testing.assert_array_equal(lit.sample(middles), lit.values[[0, 7, -1], [0, 5, -1]])
    beside = [(west - 0.1, north), (east + 0.1, south), (west, north + 0.1)]
    assert np.isnan(lit.sample(beside)).all()
    seen = scene.viewshed(places, cell=2)
    nothing = np.argwhere(seen.values == seen.nodata)
    row, column = nothing[0] if len(nothing) else (0, 0)
    assert np.isnan(seen.sample([[seen.x[column], seen.y[row]]])).all() == bool(len(nothing))


def test_units_and_suns_come_along(scene, places):
    time = "2026-06-21T15:00+02:00"
    lit = scene.shadow(time=time, cell=4)
    assert lit.unit == "1" and lit.tags["TIME"] == "2026-06-21T15:00:00+02:00" and lit.tags["TIME_ZONE"] == "+02"
    hours = scene.sun_hours(date="2026-06-21", cell=4)
    assert [hours[name].unit for name in ("sun_hours", "sun_share", "first_light")] == ["h", "1", "h"]
    assert scene.irradiance(clear_sky="haurwitz", cell=8)["kwh_m2"].unit == "kWh/m2"
    assert hours["sun_hours"].to_xarray().attrs["units"] == "h" and lit.to_xarray().attrs["time"] == lit.tags["TIME"]


def test_packages_and_shapefiles_of_geopandas_are_those_of_geojson(scene, run_program, folder, places):
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    line = shapely.LineString(places)
    frame = geopandas.GeoDataFrame({"name": ["walk"]}, geometry=[line], crs=28992)
    frame.to_crs(4326).to_file(folder / "walk.geojson")
    frame.to_file(folder / "walk.gpkg", layer="walks")
    frame.to_crs(4326).to_file(folder / "degrees.gpkg")
    frame.to_file(folder / "walk.shp")
    tables = {}
    for name in ("walk.geojson", "walk.gpkg", "degrees.gpkg", "walk.shp"):
        run_program(
            *("comfort", "tile.laz", "--route", name, "--date", "2026-03-21", "--time-step-min", 60, "-o", "walk.csv")
        )
        tables[name] = np.genfromtxt(folder / "walk.csv", delimiter=",", names=True, usecols=("x", "y", "sun_hours"))
    for name, table in tables.items():
        for column in ("x", "y"):
            np.testing.assert_allclose(table[column], tables["walk.gpkg"][column], atol=0.02, err_msg=name)
    # the same place in the plane of the file, to its last digit
    np.testing.assert_array_equal(tables["walk.shp"], tables["walk.gpkg"])
    # two layers are one too many
    frame.to_file(folder / "walk.gpkg", layer="others")
    with pytest.raises(subprocess.CalledProcessError):
        run_program("comfort", "tile.laz", "--route", "walk.gpkg", "--date", "2026-03-21", "-o", "walk.csv")


def test_areas_in_a_package_are_read_by_geopandas(run_program, folder):
    geopandas = pytest.importorskip("geopandas")
    shadow = ("shadow", "tile.laz", "--sun", "180,40", "--cell", 2, "-o", "lit.tif", "--casters", "--outlines")
    run_program(*shadow, "shade.gpkg")
    run_program(*shadow, "shade.geojson")
    package, json = (geopandas.read_file(folder / name) for name in ("shade.gpkg", "shade.geojson"))
    # the cloud has heights of NAP
    assert package.crs.to_epsg() in (7415, 28992) and set(package["caster"]) == set(json["caster"])
    assert package.geometry.is_valid.all()
    np.testing.assert_allclose(package.geometry.area, package["area_m2"], rtol=1e-6)
    same = json.to_crs(28992).geometry.area
    np.testing.assert_allclose(same, package.geometry.area, rtol=0.01)
    assert geopandas.list_layers(folder / "shade.gpkg")["name"].tolist() == ["shade"]


# at night all is in shadow
@pytest.mark.filterwarnings("ignore:.*horizon:belvedere.BelvedereWarning")
def test_a_day_is_a_file_that_xarray_and_gdal_open_at_its_times_and_place(scene, tmp_path):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    rasterio = pytest.importorskip("rasterio")
    pytest.importorskip("rioxarray")
    # the clocks of Amsterdam run two hours before UTC in June
    hours = pandas.date_range("2026-06-21", periods=24, freq="h", tz="Europe/Amsterdam")
    day = scene.shadow(time=hours, cell=4)
    day.to_xarray().to_netcdf(tmp_path / "day.nc")
    with xarray.open_dataarray(tmp_path / "day.nc") as again:
        assert again.dims == ("time", "y", "x") and again.attrs["units"] == "1"
        local = again["time"].to_index().tz_localize("UTC").tz_convert("Europe/Amsterdam")
        assert (local == hours).all()
        lit = again.sel(time="2026-06-21T13:00")
        np.testing.assert_array_equal(lit, scene.shadow(time="2026-06-21T15:00+02:00", cell=4))
        # the sun is highest an hour and forty minutes after noon
        assert int(again["sun_elevation_deg"].argmax("time")) == 14
    with xarray.open_dataarray(tmp_path / "day.nc", decode_coords="all") as again:
        assert again.rio.crs.to_epsg(20) in (7415, 28992) and again.rio.transform()[:6] == day[0].transform
    with rasterio.open(f"netcdf:{tmp_path / 'day.nc'}:lit") as file:
        assert file.count == 24 and file.transform[:6] == day[0].transform and tuple(file.bounds) == day[0].bounds
        assert file.crs.linear_units == "metre" and np.isnan(file.nodata) and file.units[0] == "1"
        np.testing.assert_array_equal(file.read(16), day[15])
    seen = scene.viewshed((154985, 462975), cell=4)
    seen.to_xarray().to_netcdf(tmp_path / "seen.nc")
    with rasterio.open(f"netcdf:{tmp_path / 'seen.nc'}:{seen.name}") as file:
        assert file.nodata == 255 and tuple(file.bounds) == seen.bounds
        np.testing.assert_array_equal(file.read(1), seen.values)


def test_a_day_is_a_store_of_zarr(scene, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("zarr")
    day = scene.shadow(time=["2026-06-21T10:00Z", "2026-06-21T11:00Z"], cell=8).to_xarray()
    day.to_zarr(tmp_path / "day.zarr")
    with xarray.open_dataarray(tmp_path / "day.zarr", engine="zarr") as again:
        xarray.testing.assert_identical(again.load().drop_attrs(), day.drop_attrs())


def test_suns_without_times_are_counted(scene):
    pytest.importorskip("xarray")
    both = scene.shadow(sun=[(180, 30), (90, 20)], cell=8).to_xarray()
    assert both.dims == ("sun", "y", "x") and both["sun_azimuth_deg"].values.tolist() == [180, 90]


def test_tables_are_places_by_the_names_of_their_columns(scene, places):
    pandas = pytest.importorskip("pandas")
    hours = scene.sun_hours(date="2026-03-21", targets=places)["sun_hours"]
    (x0, y0), (x1, y1) = places
    columns = {"name": ["a", "b"], "y": [y0, y1], "x": [x0, x1]}
    for given in (columns, pandas.DataFrame(columns), pandas.DataFrame(columns)[["y", "x"]]):
        np.testing.assert_array_equal(scene.sun_hours(date="2026-03-21", targets=given)["sun_hours"], hours)
    # a table that knows its places
    seen = scene.isovist(places)
    np.testing.assert_array_equal(scene.viewshed(seen, cell=4), scene.viewshed(seen.places, cell=4))


def test_shapes_in_any_system_are_where_they_are(scene, places):
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    x, y = places[0]
    parcel = shapely.box(x, y, x + 8, y + 8)
    front = shapely.LineString([(x, y + 12), (x + 8, y + 12)])

    def degrees(shape):
        return geopandas.GeoSeries([shape], crs=28992).to_crs(4326)

    def corners(shape):
        return np.asarray(shape.exterior.coords)[:-1]

    keywords = {"sun": (180, 30), "max_height": 20, "cell": 1}
    expected = scene.envelope(corners(parcel), protect=np.asarray(front.coords), **keywords)
    for given, line in ((parcel, front), (degrees(parcel), degrees(front)), (degrees(parcel), [degrees(front)])):
        height = scene.envelope(given, protect=line, **keywords)
        assert height.mean() == pytest.approx(expected.mean(), rel=0.02)
    # a hole stays as it is
    garden = parcel.difference(shapely.box(x + 2, y + 2, x + 4, y + 4))
    cleared = [scene.without(one).report["cleared"]["points_cleared"] for one in (parcel, degrees(parcel), garden)]
    assert cleared[0] == scene.without(corners(parcel)).report["cleared"]["points_cleared"] >= cleared[2]
    assert abs(cleared[0] - cleared[1]) <= 0.02 * cleared[0] + 2
    station = degrees(shapely.Point(x, y))
    plan = scene.survey_plan(station, (154980, 462970), (154960, 462990), count=1)
    assert np.hypot(*(plan.places[0, :2] - (x, y))) < 0.5
    with pytest.raises(belvedere.BelvedereError, match="one polygon"):
        scene.without(shapely.MultiPolygon([parcel, shapely.box(0, 0, 1, 1)]))
