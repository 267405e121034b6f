"""The interpreter stays free, Ctrl-C stops, progress is reported, and time zones are taken as they are."""

from __future__ import annotations

import datetime
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from belvedere import BelvedereWarning


def long_work(scene, progress=None):
    """Several seconds of work on any machine."""
    return scene.sky_view(directions=20_000, cell=0.1, progress=progress)


def test_other_threads_run_during_work(scene):
    """A thread that wakes every millisecond keeps waking."""
    stop = threading.Event()
    beats: list[float] = []

    def beat():
        while not stop.is_set():
            beats.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=beat)
    thread.start()
    begun = time.perf_counter()
    scene.sky_view(directions=2000, cell=1)
    seconds = time.perf_counter() - begun
    stop.set()
    thread.join()
    during = [beat for beat in beats if begun < beat < begun + seconds]
    # a blocked interpreter would let the other thread wake once at most
    assert len(during) > 20 * seconds, (len(during), seconds)


@pytest.mark.skipif(sys.platform == "win32", reason="signals are others there")
def test_ctrl_c_stops_long_before_the_end(tile):
    script = textwrap.dedent(f"""
        import belvedere, os, signal, threading, time
        scene = belvedere.Scene(belvedere.read({str(tile)!r}))
        scene.sky_view(directions=10, cell=5)
        # who started the tests in the background may have had Ctrl-C ignored
        signal.signal(signal.SIGINT, signal.default_int_handler)
        begun, sent = time.perf_counter(), []
        # interrupts once a hundredth of the work is done
        def interrupt(stage, done, total):
            if stage == "testing sky" and done > 0.01 * total and not sent:
                sent[:] = [time.perf_counter(), done / total]
                threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT)).start()
        try:
            scene.sky_view(directions=5000, cell=0.5, progress=interrupt)
        except KeyboardInterrupt:
            moment, share = sent
            print((time.perf_counter() - moment) / ((moment - begun) / share))
        # the scene still answers
        assert scene.shadow(sun=(180, 30)).values.size
    """)
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    # of the time that all of the work would take, on a machine of any speed
    assert float(result.stdout) < 0.25, result.stdout


def test_progress_counts_to_the_end_and_what_it_raises_stops_the_work(scene):
    calls = []
    scene.sky_view(directions=600, cell=1, progress=lambda *call: calls.append(call))
    stages = {stage for stage, _, _ in calls}
    assert "testing sky" in stages
    assert all(isinstance(done, int) and done >= 0 and (total == 0 or done <= total) for _, done, total in calls)
    stage, done, total = calls[-1]
    assert (stage, done) == ("testing sky", total)

    class Stop(Exception):
        pass

    stopped: list[float] = []

    def stop(stage, done, total):
        # the first stages do not know how long they take
        stopped.append(done / total if total else 0.0)
        raise Stop

    with pytest.raises(Stop):
        long_work(scene, progress=stop)
    # nothing is reported after that
    assert len(stopped) == 1
    assert stopped[0] < 0.25


def test_a_bar_is_shown_where_it_is_wanted(scene, capfd):
    pytest.importorskip("tqdm")
    scene.sky_view(directions=600, cell=1, progress=True)
    assert "testing sky" in capfd.readouterr().err


def test_questions_from_several_threads_get_the_same_answers(scene, eye, targets):
    usual = scene.visible(eye, targets)
    answers: list[np.ndarray] = []
    threads = [threading.Thread(target=lambda: answers.append(scene.visible(eye, targets))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 4 and all((answer == usual).all() for answer in answers)


def test_times_with_any_zone_are_the_same_instant(scene, targets):
    pandas = pytest.importorskip("pandas")
    noon = datetime.datetime(2026, 6, 21, 13, 0, tzinfo=ZoneInfo("Europe/Amsterdam"))
    same = [
        noon.astimezone(datetime.timezone.utc),
        noon.astimezone(ZoneInfo("Asia/Tokyo")),
        pandas.Timestamp("2026-06-21T13:00", tz="Europe/Amsterdam"),
        "2026-06-21T13:00+02:00",
        "2026-06-21T11:00Z",
    ]
    expected = scene.sun_position(noon)
    assert all((scene.sun_position(time) == expected).all() for time in same)
    index = pandas.date_range("2026-06-21T11:00", periods=3, freq="h", tz="UTC")
    assert scene.sun_position(index).shape == (3, 2)
    assert (scene.sun_position(index)[0] == expected).all()
    # pvlib 0.16.1 (NREL SPA, apparent elevation) at 52.155174 N, 5.387207 E, 5 m
    assert expected == pytest.approx([161.137924, 60.274584], abs=0.001)


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_a_million_targets_cost_milliseconds_beside_the_answers(scene, cloud, kind):
    """In and out of Rust: measured with targets outside the cloud, which need no line of sight."""
    far = np.tile(cloud.bounds[0] - 1000.0, (1_000_000, 1)).astype(kind)
    eye = cloud.bounds[0] - 2000.0
    seconds = []
    with pytest.warns(BelvedereWarning, match="outside the cloud"):
        for _ in range(4):
            # of processors, as other work on a shared machine only makes one wait
            begun = time.process_time()
            scene.visible(eye, far)
            seconds.append(time.process_time() - begun)
    # tens of milliseconds on a free core; a shared core is slower, a loop over rows in Python a hundred times
    assert min(seconds) < 1.0, seconds


def test_results_do_not_depend_on_the_number_of_threads(tile, folder):
    script = (
        "import belvedere, sys\n"
        f"scene = belvedere.Scene(belvedere.read({str(tile)!r}))\n"
        "sys.stdout.buffer.write(scene.sky_view(cell=2)['sky_view_factor'].values.tobytes())\n"
    )
    outputs = [
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "RAYON_NUM_THREADS": threads},
            capture_output=True,
            check=True,
        ).stdout
        for threads in ("1", "3")
    ]
    assert outputs[0] == outputs[1] and len(outputs[0]) > 1000


@pytest.mark.parametrize("of_others", [signal.default_int_handler, signal.SIG_IGN])
def test_signals_of_others_are_left_alone(scene, of_others):
    before = signal.signal(signal.SIGINT, of_others)
    try:
        scene.sky_view(directions=10, cell=5)
        assert signal.getsignal(signal.SIGINT) is of_others
    finally:
        signal.signal(signal.SIGINT, before)
