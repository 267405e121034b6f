"""Lines that users of other packages write, without a look at the documentation, work; mypy knows their types."""

from __future__ import annotations

from datetime import date, datetime, timezone
from pathlib import Path
from zoneinfo import ZoneInfo

import belvedere
import numpy as np
import pytest
from belvedere import Answer, Cloud, Raster, Scene

gpd = pytest.importorskip("geopandas")
matplotlib = pytest.importorskip("matplotlib")
pd = pytest.importorskip("pandas")
pvlib = pytest.importorskip("pvlib")
rasterio = pytest.importorskip("rasterio")
rioxarray = pytest.importorskip("rioxarray")
shapely = pytest.importorskip("shapely")
xr = pytest.importorskip("xarray")
matplotlib.use("agg")
# targets may lie inside obstacles, and the town is small
pytestmark = pytest.mark.filterwarnings("ignore::belvedere.BelvedereWarning")
plt = pytest.importorskip("matplotlib.pyplot")

ZONE = "Europe/Amsterdam"
TIME = datetime(2026, 6, 21, 15, tzinfo=ZoneInfo(ZONE))
TIMES = pd.date_range("2026-06-21 09:00", "2026-06-21 18:00", freq="3h", tz=ZONE)


@pytest.fixture(scope="module")
def lit(scene: Scene) -> Raster:
    return scene.shadow(time=TIME, cell=2)


@pytest.fixture(scope="module")
def day(scene: Scene) -> belvedere.RasterSeries:
    return scene.shadow(time=TIMES, cell=2)


@pytest.fixture(scope="module")
def people(standing: tuple[float, float]):
    """Two people in the street, of geopandas."""
    x, y = standing
    return gpd.GeoDataFrame({"name": ["Ann", "Bob"]}, geometry=gpd.points_from_xy([x, x + 5], [y, y]), crs=28992)


@pytest.fixture(scope="module")
def frame(targets: np.ndarray):
    """Places as a frame of pandas."""
    return pd.DataFrame(targets, columns=["x", "y", "z"])


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


# ---- numpy


def test_share_of_sun(lit: Raster):
    share: float = float(lit.mean())
    assert 0 < share < 1 and share == pytest.approx(np.nanmean(lit)) and share == pytest.approx(np.mean(lit))


def test_shape(lit: Raster):
    assert lit.shape == lit.values.shape == np.asarray(lit).shape
    assert (lit.dtype, lit.ndim, lit.size) == (lit.values.dtype, 2, lit.values.size)


def test_mask_by_itself(lit: Raster):
    assert (lit[lit == 1] == 1).all() and len(lit[lit == 1]) == (lit == 1).sum()


def test_masks_together(lit: Raster):
    both = (lit > 0.5) & ~np.isnan(lit)
    assert both.sum() == (lit == 1).sum()


def test_where(lit: Raster):
    assert np.where(lit == 1, 1, 0).sum() == (lit.values == 1).sum()


def test_stack(day: belvedere.RasterSeries):
    assert np.stack(day).shape == np.asarray(day).shape == (4, *day[0].shape)


def test_mean_of_a_day(day: belvedere.RasterSeries):
    np.testing.assert_allclose(np.mean(day, axis=0), sum(day) / len(day))
    np.testing.assert_allclose(np.mean(day, axis=0), np.mean([lit.values for lit in day], axis=0))


def test_meshgrid(lit: Raster):
    x, y = np.meshgrid(lit.x, lit.y)
    assert x.shape == lit.shape and y[0, 0] > y[-1, 0]


def test_flat_values(lit: Raster):
    flat = lit.values.ravel()
    assert np.unique(flat[np.isfinite(flat)]).tolist() == [0, 1]
    assert np.nanpercentile(lit, 100) == 1


def test_difference(scene: Scene, day: belvedere.RasterSeries):
    change = day[1] - day[0]
    assert isinstance(change, Raster) and -1 <= change.min() <= change.max() <= 1


def test_roofs_seen(scene: Scene, cloud: Cloud, eye: tuple[float, float, float]):
    roofs = cloud.xyz[cloud.attributes["classification"] == 6][::20]
    seen = scene.visible(eye, roofs)
    assert roofs[seen == Answer.VISIBLE].shape == (np.count_nonzero(seen == 1), 3)


def test_no_targets_give_no_answers(scene: Scene, eye: tuple[float, float, float]):
    assert scene.visible(eye, np.empty((0, 3))).shape == (0,)


def test_sun_of_an_array(scene: Scene, frame):
    one = scene.shadow(sun=np.array([180.0, 30]), targets=frame.to_numpy())
    two = scene.shadow(sun=np.array([[180.0, 30], [90, 20]]), targets=frame.to_numpy())
    np.testing.assert_array_equal(one, two[0])
    assert np.asarray(two).shape == (2, len(frame))


def test_one_place_of_a_raster(lit: Raster):
    assert lit.sample((lit.x[3], lit.y[4])) == lit.values[4, 3]


def test_cloud_from_arrays(cloud: Cloud):
    again = belvedere.Cloud(cloud.xyz, crs=28992, classification=cloud.attributes["classification"])
    assert len(again) == len(cloud.xyz) == len(cloud)


# ---- times


def test_timestamp(scene: Scene, lit: Raster):
    same = scene.shadow(time=pd.Timestamp("2026-06-21 15:00", tz=ZONE), cell=2)
    np.testing.assert_array_equal(same, lit)


def test_text_and_utc(scene: Scene, lit: Raster):
    np.testing.assert_array_equal(scene.shadow(time="2026-06-21T15:00+02:00", cell=2), lit)
    np.testing.assert_array_equal(scene.shadow(time="2026-06-21 13:00Z", cell=2), lit)
    np.testing.assert_array_equal(scene.shadow(time=datetime(2026, 6, 21, 13, tzinfo=timezone.utc), cell=2), lit)


def test_times_of_a_frame(scene: Scene, day: belvedere.RasterSeries, people):
    log = pd.DataFrame({"power": 1.0}, index=TIMES)
    assert len(day) == len(scene.shadow(time=log.index, targets=people)) == 4
    assert len(scene.shadow(time=log.reset_index()["index"], targets=people)) == 4
    log["sun"] = np.asarray(scene.shadow(time=log.index, targets=people))[:, 0]
    assert log["sun"].between(0, 1).all()


def test_now(scene: Scene):
    azimuth, elevation = scene.sun_position(datetime.now(timezone.utc))
    assert 0 <= azimuth < 360 and -90 < elevation < 90


def test_suns_as_a_frame(scene: Scene):
    suns = pd.DataFrame(scene.sun_position(TIMES), index=TIMES, columns=["azimuth", "elevation"])
    assert suns["azimuth"].is_monotonic_increasing and (suns["elevation"] > 0).all()


def test_days(scene: Scene, people):
    one = scene.sun_hours(date=date(2026, 6, 21), targets=people, zone=ZONE)
    other = scene.sun_hours(date="2026-06-21", targets=people, zone=ZoneInfo(ZONE))
    np.testing.assert_array_equal(one["sun_hours"], other["sun_hours"])


def test_period(scene: Scene, people):
    june = scene.sun_hours(period=("2026-06-01", "2026-06-30"), time_step_min=60, targets=people, zone=ZONE)
    days = scene.sun_hours(date=pd.date_range("2026-06-01", "2026-06-30"), time_step_min=60, targets=people, zone=ZONE)
    np.testing.assert_allclose(june["sun_hours"], days["sun_hours"], rtol=1e-6)


# ---- xarray


def test_xarray_plots(lit: Raster):
    # xarray declares its plots in a way that mypy does not read
    assert lit.to_xarray().plot() is not None  # type: ignore[call-arg]


def test_crs_of_xarray(lit: Raster):
    array = lit.to_xarray()
    assert array.rio.crs.to_epsg(20) in (28992, 7415) and array.rio.transform()[:6] == lit.transform


def test_dataset_of_hours(scene: Scene):
    hours = scene.sun_hours(date="2026-06-21", cell=4, time_step_min=60, zone=ZONE).to_xarray()
    assert float(hours["sun_hours"].max()) <= 17 and hours.sun_hours.attrs["units"] == "h"


def test_select_a_place(lit: Raster):
    assert lit.to_xarray().sel(x=lit.x[2], y=lit.y[5] + 0.3, method="nearest") == lit.values[5, 2]


def test_day_in_xarray(day: belvedere.RasterSeries):
    stack = day.to_xarray()
    assert stack.dims == ("time", "y", "x") and stack.sizes["time"] == 4
    np.testing.assert_array_equal(stack.sel(time="2026-06-21 13:00").squeeze(), day[2])
    np.testing.assert_array_equal(stack.mean("time"), np.mean([lit.values for lit in day], axis=0))


def test_day_by_hand(day: belvedere.RasterSeries):
    stack = xr.concat([lit.to_xarray() for lit in day], pd.Index(day.to_xarray()["time"].values, name="time"))
    np.testing.assert_array_equal(stack, day.to_xarray())


def test_rasterio_opens_what_rioxarray_writes(lit: Raster, tmp_path: Path):
    lit.to_xarray().rio.to_raster(tmp_path / "lit.tif")
    with rasterio.open(tmp_path / "lit.tif") as file:
        assert file.transform[:6] == lit.transform
        np.testing.assert_array_equal(file.read(1), lit.values)


def test_reproject(lit: Raster):
    degrees = lit.to_xarray().rio.reproject("EPSG:4326")
    assert 51 < float(degrees.y.mean()) < 53 and 5 < float(degrees.x.mean()) < 6


def test_two_results_in_a_dataset(scene: Scene, lit: Raster, standing: tuple[float, float]):
    seen = scene.viewshed(standing, cell=2)
    both = xr.Dataset({"lit": lit.to_xarray(), "seen": seen.to_xarray()})
    assert int(((both.lit == 1) & (both.seen == 1)).sum()) <= (lit == 1).sum()


# ---- pandas and polars


def test_table_of_pandas(scene: Scene, eye: tuple[float, float, float], frame):
    table = scene.line_of_sight(eye, frame)
    counts = table.to_pandas().groupby("answer").size()
    assert counts.sum() == len(frame) == table.row_count == len(pd.DataFrame(table))


def test_table_of_polars(scene: Scene, eye: tuple[float, float, float], frame):
    pl = pytest.importorskip("polars")
    table = pl.DataFrame(scene.line_of_sight(eye, frame))
    assert table.filter(pl.col("answer") == 1).height <= len(frame)


def test_column_of_answers(scene: Scene, eye: tuple[float, float, float], frame):
    checked = frame.assign(visible=scene.visible(eye, frame[["x", "y", "z"]]) == Answer.VISIBLE)
    assert checked["visible"].dtype == bool


def test_places_of_polars(scene: Scene, frame):
    pl = pytest.importorskip("polars")
    places = pl.DataFrame({name: frame[name].to_numpy() for name in "xyz"})
    there = scene.shadow(sun=(180, 30), targets=places)
    np.testing.assert_array_equal(there, scene.shadow(sun=(180, 30), targets=frame))


def test_windows_of_a_frame(scene: Scene, standing: tuple[float, float], cloud: Cloud):
    x, y = standing
    windows = pd.DataFrame({"x": [x], "y": [y], "z": [cloud.bounds[0][2] + 8], "azimuth": [180]})
    views = scene.window_views(windows)
    assert 0 <= views["sky"][0] <= 100
    assert scene.comfort(windows=windows, date="2026-06-21", zone=ZONE)["sun_hours"].shape == (1,)


def test_towers_of_a_frame(scene: Scene, standing: tuple[float, float], people):
    x, y = standing
    towers = pd.DataFrame({"x": [x], "y": [y], "tip": [30.0], "name": ["mast"]})
    assert scene.towers(towers, targets=people).row_count == 2


# ---- geopandas and shapely


def test_point(scene: Scene, standing: tuple[float, float]):
    seen = scene.viewshed(shapely.Point(*standing), cell=2)
    np.testing.assert_array_equal(seen, scene.viewshed(standing, cell=2))


def test_new_column(scene: Scene, people):
    people = people.assign(sun=scene.sun_hours(date="2026-06-21", targets=people, zone=ZONE)["sun_hours"])
    same = scene.sun_hours(date="2026-06-21", targets=people.geometry, zone=ZONE)["sun_hours"]
    np.testing.assert_array_equal(people["sun"], same)


def test_map_of_results(scene: Scene, people):
    found = scene.sun_hours(date="2026-06-21", targets=people, zone=ZONE).to_geodataframe()
    assert found.plot(column="sun_hours") is not None and found.crs is not None
    np.testing.assert_allclose(found.geometry.x, people.geometry.x, atol=0.01)


def test_walk(scene: Scene, standing: tuple[float, float]):
    x, y = standing
    line = shapely.LineString([(x, y), (x + 10, y)])
    walk = scene.comfort(route=line, date="2026-06-21", zone=ZONE)
    assert walk["distance_m"].max() == line.length
    frame = gpd.GeoDataFrame(geometry=[line], crs=28992).to_crs(4326)
    again = scene.comfort(route=frame, date="2026-06-21", zone=ZONE)
    assert again["distance_m"].max() == pytest.approx(line.length, abs=0.001)


def test_without_a_footprint(scene: Scene, standing: tuple[float, float]):
    footprint = shapely.Point(standing).buffer(15)
    assert scene.without(footprint).shadow(sun=(180, 30), cell=4).mean() >= 0
    assert scene.without(gpd.GeoSeries([footprint], crs=28992)).bounds[0].shape == (3,)


def test_parcel_and_neighbour(scene: Scene):
    parcel = shapely.box(154985, 462970, 154995, 462980)
    front = shapely.LineString([(154983, 462986), (154997, 462986)])
    height = scene.envelope(parcel, protect=front, date="2026-03-21", between=(10, 14), zone=ZONE, max_height=25)
    assert 0 <= height.min() <= height.max() <= 25


def test_landmark_by_its_footprint(scene: Scene, standing: tuple[float, float], people):
    x, y = standing
    views = scene.landmark(target_polygon=shapely.box(x - 30, y - 30, x + 30, y + 30), observers=people)
    assert views.row_count == 2


def test_bounds_of_others(tile: Path, lit: Raster, people):
    near = belvedere.read(tile, bounds=people.buffer(10).total_bounds)
    assert np.ptp(near.xyz[:, 0]) <= 25
    assert len(belvedere.read(tile, bounds=shapely.box(*lit.bounds).bounds)) > len(near)
    assert len(belvedere.read(tile, bounds=lit.bounds)) > len(near)


def test_cameras_on_points(scene: Scene, people):
    assert scene.cameras(people, count=1, fov_deg=360, cell=4).cameras.row_count == 1


def test_sample_at_points(lit: Raster, people):
    np.testing.assert_array_equal(lit.sample(people), lit.sample(people.to_crs(4326)))


def test_points_with_height(scene: Scene, eye: tuple[float, float, float], people):
    there = gpd.GeoSeries(shapely.force_3d(people.geometry, z=eye[2]), crs=28992)
    assert scene.visible(eye, there).shape == (2,)
    assert scene.line_of_sight(shapely.Point(*eye), there)["answer"].shape == (2,)


def test_saves_a_package(scene: Scene, people, tmp_path: Path):
    scene.isovist(people).to_geodataframe().to_file(tmp_path / "spaces.gpkg")
    assert len(gpd.read_file(tmp_path / "spaces.gpkg")) == 2


def test_latitude_and_longitude_are_in_that_order(scene: Scene, people):
    degrees = people.to_crs(4326).geometry
    seen = scene.viewshed((degrees.y[0], degrees.x[0]), cell=2)
    assert (seen == 1).any()


# ---- pvlib


def test_sun_of_pvlib(scene: Scene, people):
    site = pvlib.location.Location(52.155, 5.387, tz=ZONE)
    sun = site.get_solarposition(TIMES)
    ours = scene.shadow(time=TIMES, targets=people)
    np.testing.assert_array_equal(scene.shadow(sun=sun[["azimuth", "apparent_elevation"]], targets=people), ours)


def test_clear_sky_of_pvlib(scene: Scene, people):
    site = pvlib.location.Location(52.155, 5.387, tz=ZONE)
    hours = pd.date_range("2026-01-01", "2026-12-31 23:00", freq="h", tz=ZONE)
    energy = scene.irradiance(weather=site.get_clearsky(hours), location=site, targets=people)
    assert (energy["kwh_m2"] > 100).all()


def test_horizon_of_pvlib(scene: Scene, standing: tuple[float, float]):
    azimuths, elevations = scene.horizon(standing)
    sun = pvlib.solarposition.get_solarposition(TIMES, 52.155, 5.387)
    free = sun["apparent_elevation"] > np.interp(sun["azimuth"], azimuths, elevations, period=360)
    assert free.index.equals(TIMES)


# ---- matplotlib


def test_plot(lit: Raster, tmp_path: Path):
    lit.plot()
    plt.savefig(tmp_path / "lit.png")
    assert (tmp_path / "lit.png").stat().st_size > 1000


def test_plot_into_axes(lit: Raster):
    figure, axes = plt.subplots()
    lit.plot(ax=axes, cmap="gray", vmin=0, vmax=1).set_title("three o'clock")
    assert axes.get_title() == "three o'clock"


def test_plots_of_a_day(day: belvedere.RasterSeries):
    figure, axes = plt.subplots(2, 2, sharex=True, sharey=True)
    for part, lit in zip(axes.flat, day, strict=True):
        lit.plot(ax=part, add_colorbar=False)
    assert len(figure.axes) == 4


def test_imshow(lit: Raster):
    west, south, east, north = lit.bounds
    picture = plt.imshow(lit, extent=(west, east, south, north), cmap="gray")
    np.testing.assert_array_equal(picture.get_array().filled(np.nan), lit.values)


def test_contours(lit: Raster):
    assert plt.contour(lit.x, lit.y, lit, levels=[0.5]) is not None


def test_histogram(lit: Raster):
    counts, _, _ = plt.hist(lit.values.ravel(), bins=2, range=(0, 1))
    assert counts[1] == (lit == 1).sum()


def test_scatter(scene: Scene, eye: tuple[float, float, float], targets: np.ndarray):
    dots = plt.scatter(targets[:, 0], targets[:, 1], c=scene.visible(eye, targets))
    assert len(dots.get_offsets()) == len(targets)


def test_panorama(scene: Scene, eye: tuple[float, float, float]):
    picture = plt.imshow(scene.depth_map(eye=eye, width=64))
    assert picture.get_array().shape == (32, 64)


def test_skyline(scene: Scene, standing: tuple[float, float]):
    (line,) = plt.plot(*scene.horizon(standing))
    assert len(line.get_xdata()) == 360


def test_outline_of_a_building_over_the_shadow(lit: Raster, people):
    axes = lit.plot()
    people.buffer(5).boundary.plot(ax=axes)
    west, south, east, north = lit.bounds
    assert axes.get_xlim()[0] <= west and axes.get_ylim()[1] >= north


# ---- rasterio, and the rest of Python


def test_rasterio_writes(lit: Raster, tmp_path: Path):
    profile = dict(driver="GTiff", height=lit.shape[0], width=lit.shape[1], count=1, dtype=lit.values.dtype)
    with rasterio.open(
        tmp_path / "lit.tif", "w", transform=rasterio.Affine(*lit.transform), crs=lit.crs, **profile
    ) as out:
        out.write(lit.values, 1)
    with rasterio.open(tmp_path / "lit.tif") as file:
        assert tuple(file.bounds) == pytest.approx(lit.bounds)


def test_names_of_answers(scene: Scene, eye: tuple[float, float, float], frame):
    sight = scene.line_of_sight(eye, frame.iloc[0])
    assert sight.answer.name in Answer.__members__
    names = [Answer(value).name for value in scene.visible(eye, frame)]
    assert set(names) <= set(Answer.__members__)


def test_coordinate_system_of_pyproj(tile: Path, lit: Raster):
    pyproj = pytest.importorskip("pyproj")
    assert pyproj.CRS(lit.crs).is_projected
    assert len(belvedere.read(tile, crs=pyproj.CRS(28992), crs_override=True)) > 0
