"""The program is found, runs, reports, fails with its own words, and can be cancelled."""

from __future__ import annotations

import os
import sys
import time

import pytest

from belvedere_qgis import program


def make_program(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return str(path)


@pytest.fixture
def nowhere(tmp_path, monkeypatch):
    """No program anywhere."""
    monkeypatch.delenv(program.ENVIRONMENT, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    monkeypatch.setattr(program, "PLUGIN", tmp_path / "plugin")
    monkeypatch.setattr(program, "_script_folders", lambda: [tmp_path / "scripts"])


@pytest.mark.usefixtures("nowhere")
def test_places_are_searched_in_their_order(tmp_path, monkeypatch):
    with pytest.raises(program.ProgramError, match=r"checkout.*docs/qgis.md"):
        program.find()
    in_plugin = make_program(tmp_path / "plugin" / "bin" / program.NAME)
    # as QGIS unpacks it
    os.chmod(in_plugin, 0o644)
    assert program.find() == in_plugin and os.access(in_plugin, os.X_OK)
    of_pip = make_program(tmp_path / "scripts" / program.NAME)
    assert program.find() == of_pip
    on_path = make_program(tmp_path / "path" / program.NAME)
    monkeypatch.setenv("PATH", str(tmp_path / "path"))
    assert program.find() == on_path
    named = make_program(tmp_path / "named")
    monkeypatch.setenv(program.ENVIRONMENT, named)
    assert program.find() == named
    of_setting = make_program(tmp_path / "setting")
    assert program.find(of_setting) == of_setting


@pytest.mark.usefixtures("nowhere")
def test_a_setting_that_names_no_program_is_said(tmp_path, monkeypatch):
    make_program(tmp_path / "plugin" / "bin" / program.NAME)
    with pytest.raises(program.ProgramError, match="settings"):
        program.find(str(tmp_path / "gone"))
    monkeypatch.setenv(program.ENVIRONMENT, str(tmp_path))
    with pytest.raises(program.ProgramError, match=program.ENVIRONMENT):
        program.find()


def test_another_program_is_refused():
    with pytest.raises(program.ProgramError, match="not belvedere"):
        program.describe("/bin/echo")


def test_a_line_of_progress_is_read_and_others_are_not():
    line = '{"stage":"carving balls","done":3,"total":10,"seconds":0.5,"finished":false}'
    assert program.progress(line) == ("carving balls", 3, 10)
    assert program.progress('{"stage":"filling","done":0,"total":null,"seconds":0.0,"finished":false}') == (
        "filling",
        0,
        None,
    )
    for other in ("error: no", "{", '{"a": 1}', "[]", ""):
        assert program.progress(other) is None


def test_a_run_reports_its_stages_and_returns_its_summary(binary, tmp_path):
    steps = []
    # large enough that several looks at the progress fall into the run
    summary = program.run(
        binary,
        ["simulate", f"--output={tmp_path / 'town'}", "--extent=150"],
        lambda *step: steps.append(step),
    )
    assert summary and (tmp_path / "town").is_dir()
    assert steps and all(total is None or 0 <= done <= total for _, done, total in steps)
    info = program.run(binary, ["info", "--", str(tmp_path / "town" / "cloud.laz")])
    assert info["points"] > 1000


def test_an_error_has_the_words_of_the_program(binary, tmp_path):
    with pytest.raises(program.ProgramError) as caught:
        program.run(
            binary,
            ["viewshed", "--observer=1,2", f"--output={tmp_path / 'x.tif'}", "--", str(tmp_path / "missing.laz")],
        )
    assert "missing.laz" in str(caught.value) and not str(caught.value).startswith("error")
    with pytest.raises(program.ProgramError, match="--output"):
        program.run(binary, ["viewshed", "--observer=1,2", "--", "missing.laz"])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows ends programs without an interrupt")
def test_a_cancelled_run_ends_soon_and_leaves_no_file(binary, tmp_path):
    start, out = time.monotonic(), tmp_path / "town"
    with pytest.raises(program.Cancelled):
        program.run(
            binary,
            ["simulate", f"--output={out}", "--extent=3000"],
            is_cancelled=lambda: time.monotonic() - start > 0.5,
        )
    assert time.monotonic() - start < 0.5 + program.PATIENCE_S + 1.0
    assert not [name for _, _, names in os.walk(out) for name in names if name.endswith(".part")]


def test_the_log_has_no_user_password_or_key():
    typed = ["shadow", "https://ann:pw@example.org/a.laz?sig=1", "--add=http://example.org/b.obj#key", "c?d.laz"]
    assert program.shown(typed) == "belvedere shadow https://example.org/a.laz?*** --add=http://example.org/b.obj?*** c?d.laz"
