"""Scenes and clouds against closed forms and against themselves."""

from __future__ import annotations

import functools
import io
import pickle
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import belvedere
import numpy as np
import pytest
from belvedere import Answer


def points_of_a_wall():
    """A level ground of 40 m and a wall of 6 m along y = 0 around the origin: positions and normals."""
    step = 0.25
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(-20, 20, step), np.arange(-20, 20, step)))
    ground = np.column_stack([x, y, np.zeros_like(x)])
    x, z = (axis.ravel() for axis in np.meshgrid(np.arange(-20, 20, step), np.arange(0, 6, step)))
    sides = [(np.column_stack([x, np.full_like(x, side * 0.5), z]), (0, side, 0)) for side in (-1, 1)]
    y, x = (axis.ravel() for axis in np.meshgrid(np.arange(-0.5, 0.75, step), np.arange(-20, 20, step)))
    top = np.column_stack([x, y, np.full_like(x, 6.0)])
    parts = [(ground[np.abs(ground[:, 1]) > 0.5], (0, 0, 1)), *sides, (top, (0, 0, 1))]
    return np.vstack([part for part, _ in parts]), np.vstack([np.broadcast_to(n, part.shape) for part, n in parts])


def wall_on_a_plain():
    """The points of a wall in the Netherlands."""
    xyz, normals = points_of_a_wall()
    return belvedere.Cloud(xyz + [155000, 463000, 5], normals=normals, crs="EPSG:28992")


@pytest.fixture(scope="module")
def wall():
    return belvedere.Scene(wall_on_a_plain(), method="tau", orient="given", keep_isolated=True)


def test_a_cloud_with_y_up_is_said_by_all_that_its_scene_answers():
    xyz, normals = (np.column_stack([x, z, -y]) for x, y, z in (of.T for of in points_of_a_wall()))
    turned = belvedere.Cloud(xyz, normals=normals)
    scene = belvedere.Scene(turned, method="tau", orient="given", keep_isolated=True)
    eye, targets = (0, 3, 10), [[5.0, 1.0, 10.0], [0.0, 1.0, -10.0]]
    for ask in (lambda: scene.visible(eye, targets), lambda: scene.line_of_sight([eye], targets[:1])):
        with pytest.warns(belvedere.BelvedereWarning) as caught:
            ask()
        assert "y-looks-up" in [warning.message.key for warning in caught]


# LAS 1.4 has no points without a time
@pytest.mark.filterwarnings("ignore:.*all GPS times are zero, so the file has none")
def test_a_system_that_contradicts_the_file_is_refused_unless_it_is_insisted_on(tmp_path):
    path = tmp_path / "wall.las"
    wall_on_a_plain().save(path)
    assert belvedere.read(path, crs="EPSG:28992").crs == "EPSG:28992"
    with pytest.raises(belvedere.BelvedereError, match=r"EPSG:2154.*wall\.las.*EPSG:28992"):
        belvedere.read(path, crs="EPSG:2154")
    assert belvedere.read(path, crs="EPSG:2154", crs_override=True).crs == "EPSG:2154"
    with pytest.raises(belvedere.BelvedereError, match="crs_override"):
        belvedere.read(path, crs_override=True)


def test_a_location_far_from_the_system_is_refused_and_a_nearer_one_is_warned_of(wall):
    with pytest.raises(belvedere.BelvedereError, match="swapped"):
        wall.sun_position("2026-06-21T10:00Z", location=(5.39, 52.15))
    with pytest.warns(belvedere.BelvedereWarning) as warned:
        wall.shadow(time="2026-06-21T10:00Z", location=(52.4, 4.9), cell=5)
    assert "location-far-away" in [one.message.key for one in warned]


def test_the_shadow_of_a_wall_is_as_long_as_the_tangent_says(wall):
    # the sun stands in the grid's south at 45 degrees: shade reaches 6 m beyond the north face at y = 0.5
    y = np.arange(0.8, 15, 0.1)
    places = np.column_stack([np.full_like(y, 155000.0), 463000 + y, np.full_like(y, 5.1)])
    lit = wall.shadow(sun=(180, 45), targets=places, grid_north=True)
    reach = 0.5 + 6 - 0.1
    assert (lit[y < reach - 0.2] == 0).all() and (lit[y > reach + 0.3] == 1).all()


def test_casters_are_an_attribute_of_a_raster_and_a_column_of_places(wall, tmp_path):
    with pytest.warns(belvedere.BelvedereWarning, match="classes of points are unknown"):
        lit = wall.shadow(sun=(180, 45), cell=1, casters=True, grid_north=True)
    known = np.isfinite(lit.values)
    # points without a class are other things
    assert set(np.unique(lit.caster.values[known])) == {0, 5}
    assert np.array_equal(lit.values[known] == 0, lit.caster.values[known] == 5)
    assert np.array_equal(pickle.loads(pickle.dumps(lit)).caster.values, lit.caster.values, equal_nan=True)
    with pytest.warns(belvedere.BelvedereWarning, match="classes of points are unknown"):
        table = wall.shadow(sun=(180, 45), targets=[(155000, 463003, 5.1)], casters=True, grid_north=True)
    assert table["lit"] == 0 and table["caster"] == 5


def test_a_wall_blocks_what_stands_behind_it_and_nothing_before_it(wall):
    eye = (155000, 463000 - 10, 6.5)
    x = np.linspace(-8, 8, 40)
    before = np.column_stack([155000 + x, np.full(40, 463000 - 2.0), np.full(40, 6.0)])
    behind = before + [0, 4, 0]
    assert (wall.visible(eye, before) == Answer.VISIBLE).all()
    assert (wall.visible(eye, behind) == Answer.BLOCKED).all()
    sight = wall.line_of_sight(eye, behind[20])
    assert sight.answer is Answer.BLOCKED
    # the south face at y = -0.5 is met after 9.5 m of 12 on the map
    length = np.linalg.norm(behind[20] - eye)
    assert sight.first_block_range_m == pytest.approx(length * 9.5 / 12, abs=0.1)
    assert sight.block[1] == pytest.approx(463000 - 0.5, abs=0.1)
    table = wall.line_of_sight(eye, np.vstack([before, behind]))
    assert table["answer"].tolist() == [1] * 40 + [0] * 40 and table.row_count == 80


def test_bytes_files_paths_and_laspy_give_the_same_cloud(tile, cloud):
    laspy = pytest.importorskip("laspy")
    with open(tile, "rb") as file:
        read = [belvedere.read(file)]
    content = tile.read_bytes()
    read += [
        belvedere.read(str(tile)),
        belvedere.read(content, name="tile.laz"),
        belvedere.read(io.BytesIO(content), name="x.laz"),
        belvedere.read(laspy.read(tile)),
    ]
    for other in read:
        assert (other.xyz == cloud.xyz).all() and other.crs == cloud.crs
        assert other.attributes.keys() == cloud.attributes.keys()
        for name, values in cloud.attributes.items():
            assert np.array_equal(other.attributes[name], values), name


def test_an_address_gives_the_cloud_of_the_file(tile, cloud):
    handler = functools.partial(SimpleHTTPRequestHandler, directory=tile.parent)
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_port}"
        try:
            np.testing.assert_array_equal(belvedere.read(f"{address}/{tile.name}").xyz, cloud.xyz)
            with pytest.raises(OSError, match=f"{address}/gone.laz.*status 404"):
                belvedere.read(f"{address}/gone.laz")
        finally:
            server.shutdown()


def test_only_points_in_a_box_and_of_classes_are_read(tile, cloud):
    low, high = cloud.bounds
    box = [low[:2] + 20.0, (low[:2] + high[:2]) / 2]
    inside = ((cloud.xyz[:, :2] >= box[0]) & (cloud.xyz[:, :2] <= box[1])).all(axis=1)
    assert 0.02 < inside.mean() < 0.3
    with open(tile, "rb") as file:
        parts = [belvedere.read(tile, bounds=box), belvedere.read(file, bounds=box)]
    for part in parts:
        # local coordinates are rounded to 32 bits from another origin
        assert part.xyz.shape == (inside.sum(), 3) and np.abs(part.xyz - cloud.xyz[inside]).max() < 1e-4
    classes = cloud.attributes["classification"]
    ground = belvedere.read(tile, bounds=np.c_[box, [low[2], high[2]]], classes=[2])
    assert np.abs(ground.xyz - cloud.xyz[inside & (classes == 2)]).max() < 1e-4


class Counting(io.BytesIO):
    """A file that counts what is read of it, as if it lay on a server."""

    count = 0

    def read(self, size=-1):
        content = super().read(size)
        self.count += len(content)
        return content


def test_of_a_file_beside_the_box_only_the_header_is_read(tile, cloud):
    far = Counting(tile.read_bytes())
    with pytest.raises(belvedere.BelvedereError, match="no points"):
        belvedere.read(far, name="far.laz", bounds=[cloud.bounds[1][:2] + 10, cloud.bounds[1][:2] + 20])
    assert 0 < far.count < len(far.getvalue()) / 3, (far.count, len(far.getvalue()))


def test_what_a_file_raises_names_the_file(tile, cloud):
    class Lost(io.BytesIO):
        def read(self, size=-1):
            if self.tell() > 200:
                raise OSError("the server does not answer")
            return super().read(size)

    with pytest.raises(OSError, match=r"far\.laz.*the server does not answer"):
        belvedere.read(Lost(tile.read_bytes()), name="far.laz", bounds=cloud.bounds)


def test_a_cloud_from_arrays_answers_as_its_file_does(cloud, scene, eye, targets):
    copied = belvedere.Cloud(cloud.xyz, crs=cloud.crs, adjusted_gps_time=True, **cloud.attributes)
    assert np.abs(copied.xyz - cloud.xyz).max() == 0
    again = belvedere.Scene(copied)
    assert (again.visible(eye, targets) == scene.visible(eye, targets)).all()


@pytest.mark.parametrize("make", [
    lambda xyz: xyz.astype(np.float32).astype(np.float64),
    lambda xyz: xyz.astype(np.float32),
    lambda xyz: np.asfortranarray(xyz.astype(np.float32)),
    lambda xyz: np.repeat(xyz.astype(np.float32), 2, axis=0)[::2],
    lambda xyz: xyz.astype(np.float32)[::-1][::-1],
    lambda xyz: xyz.astype(np.float32).tolist(),
])  # fmt: skip
def test_arrays_of_any_layout_are_taken_and_left_alone(scene, cloud, make):
    targets = make(cloud.xyz[::500])
    if isinstance(targets, np.ndarray):
        targets.flags.writeable = False
    usual = scene.visible(cloud.xyz[7], cloud.xyz[::500].astype(np.float32))
    assert (scene.visible(cloud.xyz[7], targets) == usual).all()


def test_pickled_scenes_and_clouds_answer_the_same(scene, cloud, eye, targets):
    again = pickle.loads(pickle.dumps(cloud))
    assert (again.xyz == cloud.xyz).all() and again.report == cloud.report
    again = pickle.loads(pickle.dumps(scene))
    assert repr(again) == repr(scene) and again.report == scene.report
    assert (again.visible(eye, targets) == scene.visible(eye, targets)).all()
    lit = scene.shadow(sun=(180, 30))
    assert np.array_equal(again.shadow(sun=(180, 30)).values, lit.values, equal_nan=True)
    assert np.array_equal(pickle.loads(pickle.dumps(lit)).values, lit.values, equal_nan=True)


def test_a_saved_scene_without_its_cloud_answers_points_and_refuses_cells(scene, folder, eye, targets):
    scene.save(folder / "saved.npz")
    loaded = belvedere.Scene.load(folder / "saved.npz")
    assert loaded.cloud is None
    assert (loaded.visible(eye, targets) == scene.visible(eye, targets)).all()
    with pytest.raises(belvedere.BelvedereError, match="give its cloud"):
        loaded.shadow(sun=(180, 30))


def test_trees_let_light_through_and_soft_edges_lie_between(scene):
    hard = scene.shadow(sun=(180, 30)).values
    through = scene.shadow(sun=(180, 30), through_trees=0.5).values
    soft = scene.shadow(sun=(180, 30), soft=True).values
    known = np.isfinite(hard)
    assert (through[known] >= hard[known]).all() and (through[known] > hard[known]).any()
    assert ((soft[known] > 0) & (soft[known] < 1)).any()
    assert abs(np.nanmean(soft) - np.nanmean(hard)) < 0.02


def test_lists_of_suns_give_lists_of_results(scene, targets):
    several = scene.shadow(sun=[(120, 20), (180, 60)], targets=targets)
    assert len(several) == 2
    for result, sun in zip(several, [(120, 20), (180, 60)]):
        assert np.array_equal(result, scene.shadow(sun=sun, targets=targets), equal_nan=True)


def test_a_notebook_shows_a_picture(scene):
    for thing in (scene, scene.shadow(sun=(180, 30))):
        html = thing._repr_html_()
        assert "data:image/png;base64," in html and "&lt;belvedere." in html


def test_rasters_and_tables_are_understood_by_other_packages(scene, folder, eye, targets):
    pytest.importorskip("rioxarray")
    rasterio = pytest.importorskip("rasterio")
    lit = scene.shadow(sun=(180, 30), cell=2)
    array = lit.to_xarray()
    lit.to_geotiff(folder / "other.tif")
    with rasterio.open(folder / "other.tif") as file:
        assert array.rio.transform() == file.transform and array.rio.bounds() == pytest.approx(tuple(file.bounds))
        assert tuple(array.rio.bounds()) == pytest.approx(lit.bounds)
        # a raster on the map has the horizontal part of the system
        assert (array.rio.crs.to_epsg(confidence_threshold=20), file.crs.to_epsg()) == (7415, 28992)
    dataset = scene.sky_view(cell=4).to_xarray()
    assert dataset["sky_openness"].rio.crs == array.rio.crs
    pytest.importorskip("geopandas")
    frame = scene.line_of_sight(eye, targets[:5]).to_geodataframe()
    assert frame.crs.is_projected and np.allclose(frame.geometry.x, targets[:5, 0])


def test_laspy_objects_and_paths_become_scenes(tile, scene):
    laspy = pytest.importorskip("laspy")
    assert repr(belvedere.Scene(laspy.read(tile))) == repr(belvedere.Scene(tile)) == repr(scene)


def test_a_device_changes_no_result(scene, eye, targets):
    """What is not there is refused in words."""
    other = scene.with_device("cpu")
    assert other.device is None
    assert other.device_notes == []
    assert np.array_equal(other.visible(eye, targets), scene.visible(eye, targets))
    with pytest.raises(belvedere.BelvedereError, match="auto, cpu, gpu, or the number of a device"):
        scene.with_device("fast")
    if found := belvedere.devices():
        on_device = scene.with_device(found[0].number)
        assert on_device.device == found[0].name
        sky, same = scene.sky_view(targets=targets), on_device.sky_view(targets=targets)
        assert all(np.array_equal(same[name], sky[name], equal_nan=True) for name in sky)
    else:
        with pytest.raises(belvedere.BelvedereError, match=r"without the cargo feature `gpu`|there is no device 0"):
            scene.with_device(0)


def test_a_raster_is_compared_and_computed_cell_by_cell(scene):
    """As numpy and xarray users expect: elementwise, on the same grid, NaN where there is no value."""
    lit = scene.shadow(sun=(180, 30), cell=2)
    known = ~np.isnan(lit.values)
    assert 0 < known.sum() < known.size, "the tile has cells without a value"
    for same in (lit == 1, np.float32(1) == lit, lit >= 1, np.equal(lit, 1), np.isclose(lit, 1)):
        assert np.array_equal(np.asarray(same), np.isclose(lit.values, 1))
    assert isinstance(lit == 1, belvedere.Raster) and (lit == 1).transform == lit.transform
    assert (lit == 1).sum() == np.nansum(lit.values) and (lit != 1).values.sum() == known.size - (lit == 1).sum()
    shade = 1 - lit
    assert np.array_equal(shade.values, 1 - lit.values, equal_nan=True) and shade.crs == lit.crs
    assert np.array_equal(((lit + shade) == 1).values, known)
    assert np.array_equal((lit * lit.values).values, lit.values**2, equal_nan=True)
    assert np.array_equal(np.sqrt(lit).values, np.sqrt(lit.values), equal_nan=True)
    assert np.array_equal(lit[lit == 1], lit.values[lit.values == 1])
    assert np.where(lit == 1, 5, 0).max() == 5 and np.maximum(lit, 0.5).min() == 0.5
    for truth in (lit, lit == 1):
        with pytest.raises(ValueError, match="any"):
            bool(truth)
    for other in ("lit", None, {}):
        with pytest.raises(TypeError, match="`values`"):
            lit == other  # noqa: B015
    with pytest.raises(belvedere.BelvedereError, match="grid"):
        lit + scene.shadow(sun=(180, 30), cell=4)
    with pytest.raises(TypeError, match="values"):
        np.add(lit, 1, out=lit)


def test_means_leave_cells_without_a_value_out(scene, standing):
    lit = scene.shadow(sun=(180, 30), cell=2)
    known = lit.values[~np.isnan(lit.values)]
    for name in ("mean", "sum", "min", "max", "std", "var"):
        expected = getattr(np, name)(known)
        for found in (getattr(np, name)(lit), getattr(lit, name)()):
            assert found == pytest.approx(expected, rel=1e-5), name
    assert np.mean(lit, axis=0).shape == (lit.shape[1],)
    # unsigned integers have a number for no value, which counts nowhere
    seen = scene.viewshed(standing, cell=2)
    assert seen.values.dtype.kind == "u" and (seen.values == seen.nodata).any()
    valid = seen.values[seen.values != seen.nodata]
    assert np.mean(seen) == pytest.approx(valid.mean()) and seen.max() <= 1
    assert np.nanmean(seen) == pytest.approx(valid.mean()) and np.isnan(np.asarray(seen)).sum() == (
        seen.values.size - valid.size
    )
    assert (seen > 0).sum() == (valid > 0).sum() and seen.any() and not (seen > 1).any()


def test_a_table_becomes_a_data_frame_with_its_values(scene, eye, targets):
    pandas = pytest.importorskip("pandas")
    with pytest.warns(belvedere.BelvedereWarning, match="have an end inside an obstacle"):
        sights = scene.line_of_sight(eye, targets)
    frame = pandas.DataFrame(sights)
    assert list(frame.columns) == list(sights) and len(frame) == sights.row_count
    assert frame.equals(sights.to_pandas()) and np.array_equal(frame["answer"], sights["answer"])
    space = scene.isovist(eye)
    assert space["blocked_volume_m3"][0] <= space["volume_m3"][0]
    for raised in (lambda: sights == 1, lambda: np.mean(sights), lambda: scene.sky_view(cell=4) == 1):
        with pytest.raises(TypeError, match="by name"):
            raised()


def test_a_cloud_is_saved_with_what_its_file_holds(cloud, tile, folder):
    laspy = pytest.importorskip("laspy")
    own = laspy.read(tile)
    rich = laspy.LasData(laspy.LasHeader(point_format=8, version="1.4"))
    rich.header.scales, rich.header.offsets = [0.01] * 3, np.floor(own.header.mins)
    rich.header.vlrs.append(laspy.VLR("MyCompany", 7, "of a test", b"flight 12"))
    rich.header.vlrs.extend(own.header.vlrs.get_by_id("LASF_Projection"))
    rich.header.global_encoding.wkt = True
    rich.header.global_encoding.gps_time_type = own.header.global_encoding.gps_time_type
    rich.add_extra_dim(laspy.ExtraBytesParams("Amplitude", "uint16"))
    rich.x, rich.y, rich.z, rich.gps_time = own.x, own.y, own.z, own.gps_time
    rich.classification, rich.return_number, rich.number_of_returns = own.classification, *np.ones((2, len(own)), int)
    rich.user_data, rich.nir = np.arange(len(own)) % 200, np.arange(len(own)) % 999
    rich.red = np.arange(len(own)) % 60_000
    rich["Amplitude"] = np.arange(len(own)) % 5000
    rich.write(folder / "rich.laz")
    with pytest.warns(belvedere.BelvedereWarning, match="values that are not used: Amplitude") as caught:
        read = belvedere.read(folder / "rich.laz")
    assert len(caught) == 1
    pickle.loads(pickle.dumps(read)).save(folder / "again.laz")
    again = laspy.read(folder / "again.laz")
    assert again.header.point_format.id == 8 and list(again.header.scales) == [0.01] * 3
    for name in ("X", "Y", "Z", "gps_time", "user_data", "red", "nir", "Amplitude", "classification"):
        assert np.array_equal(again[name], rich[name]), name
    assert [vlr.record_data for vlr in again.header.vlrs if vlr.user_id == "MyCompany"] == [b"flight 12"]
    with pytest.warns(belvedere.BelvedereWarning, match="Amplitude, near infrared, user data"):
        read.save(folder / "again.ply")


def test_a_scene_is_found_again_until_a_point_moves(cloud, tmp_path):
    def origin(of: belvedere.Cloud, **choices) -> str:
        return belvedere.Scene(of, cache=tmp_path / "kept", **choices).report["scene"]

    assert origin(cloud) == "kept"
    assert origin(cloud) == "found"
    assert origin(cloud, trees="opaque") == "kept"
    xyz = cloud.xyz.copy()
    xyz[0] += 0.5
    assert origin(belvedere.Cloud(xyz, crs=cloud.crs, adjusted_gps_time=True, **cloud.attributes)) == "kept"
    assert belvedere.Scene(cloud, cache=False).report["scene"] == "built"
    first, second = (belvedere.Scene(cloud, cache=cache) for cache in (False, tmp_path / "kept"))
    eye = cloud.xyz.max(axis=0) + 5
    assert (first.visible(eye, cloud.xyz[::50]) == second.visible(eye, cloud.xyz[::50])).all()


def test_a_scene_that_cannot_be_kept_is_said(cloud, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.warns(belvedere.BelvedereWarning, match="could not be kept"):
        scene = belvedere.Scene(cloud, cache=tmp_path / "file")
    assert scene.report["scene"] == "not kept"


def test_a_network_has_the_answers_of_its_pairs_in_both_directions(wall):
    # two places on each side of the wall, and one above it
    places = np.array([[-5, -8, 2], [5, -8, 2], [-5, 8, 2], [5, 8, 2], [0, 2, 12]], float) + [155000, 463000, 5]
    links = wall.network(places)
    rows = np.column_stack([links["a"], links["b"]])
    assert rows.tolist() == [[a, b] for a in range(5) for b in range(a + 1, 5)]
    # the ends of a line may change places
    for a, b in (rows.T, rows.T[::-1]):
        assert (wall.line_of_sight(places[a], places[b])["answer"] == links["answer"]).all()
    same_side = (places[rows[:, 0], 1] > 463000) == (places[rows[:, 1], 1] > 463000)
    seen = links["answer"] == Answer.VISIBLE
    among_four = (rows < 4).all(axis=1)
    assert (seen[among_four] == same_side[among_four]).all()
    assert np.allclose(links["length_m"], np.linalg.norm(places[rows[:, 0]] - places[rows[:, 1]], axis=1), atol=1e-3)
    near = wall.network(places, max_distance=11)
    apart = np.linalg.norm((places[rows[:, 0]] - places[rows[:, 1]])[:, :2], axis=1)
    assert (np.column_stack([near["a"], near["b"]]) == rows[apart <= 11]).all()
    with pytest.raises(belvedere.BelvedereError, match="two places or more"):
        wall.network(places[:1])


def test_hourly_sun_is_the_shadow_of_each_hour(wall, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    sun = wall.hourly_sun(2026, zone="+01:00", cell=2, sun_tolerance_deg=0)
    assert len(sun) == 12 * 24
    lit = wall.shadow(time="2026-03-21T15:30+01:00", cell=2)
    days = sun["03_15"]
    known = days.values != days.nodata
    assert known.any() and (known == ~np.isnan(np.asarray(lit))).all()
    bits = days.values >> 20 & 1
    assert (bits == lit.values)[known].all() and 0 < bits[known].mean() < 1
    days.to_geotiff(tmp_path / "days.tif")
    with rasterio.open(tmp_path / "days.tif") as file:
        assert (file.read(1) == days.values).all() and file.nodata == days.nodata


# the wall has no classes, and its edge is near
@pytest.mark.filterwarnings("ignore::belvedere.BelvedereWarning")
def test_a_report_takes_the_days_and_hours_of_a_study(wall, tmp_path):
    corners = [(154990, 463006, 5), (155010, 463006, 5), (155010, 463006, 20), (154990, 463006, 20)]
    screen = belvedere.Mesh(corners, [(0, 1, 2), (0, 2, 3)])
    garden = [(154996, 463011), (155004, 463011), (155004, 463015), (154996, 463015)]
    path = tmp_path / "study.html"
    wall.sunlight_report(path, areas={"garden": garden}, planned=wall.with_added(screen), study="ceqr", year=2026)
    page = path.read_text(encoding="utf-8")
    assert "CEQR Technical Manual (2021)" in page and "6 May" in page
    with pytest.raises(belvedere.BelvedereError, match=r"'paris'.*'ceqr', 'san-francisco' or 'toronto'"):
        wall.sunlight_report(path, areas={"garden": garden}, planned=wall.with_added(screen), study="paris")
    with pytest.raises(belvedere.BelvedereError, match="with areas and a plan"):
        wall.sunlight_report(path, areas={"garden": garden}, study="toronto")
