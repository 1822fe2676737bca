"""The command line: what people type, what they are told, and the exit code."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from command import Run

from foldmill_fabricate.cli.running import stopping_on_signals


def test_the_whole_way_from_parameters_to_a_simulated_plotter(foldmill: Run) -> None:
    designed = foldmill("design", "tuck", "--preset", "stool-n8", "-o", "stool.fold", "--json")
    assert designed.code == 0
    assert json.loads(designed.out)["mountains"] == 80
    checked = json.loads(foldmill("check", "stool.fold", "--json").out)
    assert checked["figures"]["penetrations"] == 0
    assert foldmill("plan", "stool.fold", "-o", "job").code == 0
    assert json.loads(foldmill("verify", "job", "--json").out)["ok"] is True
    sent = foldmill("send", "job", "--port", "sim://generic-hpgl-600", "--yes", "--draw", "cut")
    assert sent.out.count("executed") == 4
    assert Path("cut/reverse.svg").exists()


@pytest.mark.parametrize("suffix", ["fold", "svg", "png", "glb", "stl", "obj"])
def test_a_design_is_written_as_its_suffix_says(foldmill: Run, suffix: str) -> None:
    assert foldmill("design", "rotational", "-o", f"form.{suffix}").code == 0
    assert Path(f"form.{suffix}").stat().st_size > 500


def test_a_form_that_is_looked_at_only_is_not_thought_written(foldmill: Run) -> None:
    assert (
        "Nothing is written; -o rotational.fold writes it." in foldmill("design", "rotational").err
    )
    assert foldmill("design", "rotational", "-o", "a.fold").err == ""


def test_one_value_by_its_dotted_name_changes_the_form(foldmill: Run) -> None:
    told = foldmill("design", "tuck", "--preset", "stool-n8", "--tucks.0.t", "null", "--json")
    assert told.code == 0
    assert foldmill("design", "rotational", "--points.2.a=70", "-o", "a.fold").code == 0
    params = json.loads(Path("a.fold").read_text())["foldmill:design"]["params"]
    assert params["points"]["2"]["a"] == 70


def test_parameters_come_from_a_file_too(foldmill: Run) -> None:
    Path("p.toml").write_text("n = 6\n[points]\n1 = { a = 40 }\n2 = { a = 50 }\n3 = { a = 70 }\n")
    told = foldmill("design", "rotational", "--params", "p.toml", "--json")
    assert json.loads(told.out)["vertices"] == 1 + 6 * 3


def test_a_point_on_its_line_becomes_a_free_one_by_its_r_and_z(foldmill: Run) -> None:
    free = ("--points.4.r", "96", "--points.4.z", "-80", "--tucks", "[]")
    assert foldmill("design", "tuck", "--preset", "stool-n8", *free).code == 0
    told = foldmill("design", "tuck", "--preset", "stool-n8", "--points.4.a", "200", "--tucks=[]")
    assert "points.4.r" not in told.err


def test_a_form_that_penetrates_is_written_only_by_force_and_then_marked(foldmill: Run) -> None:
    points = '{"1":{"a":40},"2":{"a":90},"3":{"a":140},"4":{"a":141},"5":{"a":200},"6":{"a":201}}'
    bad = ("design", "rotational", "--n", "6", "--phi", "30", "--points", points, "-o", "bad.fold")
    told = foldmill(*bad)
    assert told.code == 1
    assert "passes through itself" in told.out
    assert not Path("bad.fold").exists()
    assert foldmill(*bad, "--force").code == 1
    assert json.loads(Path("bad.fold").read_text())["foldmill:errors"] == ["penetration"]
    assert foldmill("plan", "bad.fold", "-o", "job", "--unassigned", "skip").code == 1


@pytest.mark.parametrize("suffix", ["svg", "glb", "stl", "obj", "fold"])
def test_whatever_file_a_form_that_does_not_fold_goes_into_says_so(
    foldmill: Run, suffix: str
) -> None:
    name = f"bad.{suffix}"
    words = ("design", "rotational", "--preset", "bowl-n8", "--phi", "30", "-o", name)
    assert foldmill(*words).code == 1
    assert not Path(name).exists()
    assert foldmill(*words, "--force").code == 1
    said = b"foldmill:errors" if suffix == "fold" else b"DOES NOT FOLD: penetration"
    assert said in Path(name).read_bytes()


def test_a_form_that_does_not_fold_is_moved_only_when_that_is_wanted(foldmill: Run) -> None:
    words = ("motion", "rotational", "--preset", "bowl-n8", "--phi", "30", "--steps", "2", "-o")
    refused = foldmill(*words, "bad.fold")
    assert (refused.code, Path("bad.fold").exists()) == (1, False)
    assert "passes through itself" in refused.out
    assert foldmill(*words, "bad.fold", "--force").code == 0
    assert json.loads(Path("bad.fold").read_text())["foldmill:errors"] == ["penetration"]


def test_a_familys_help_lists_parameters_with_units(foldmill: Run) -> None:
    told = foldmill("design", "tuck", "--help").out
    assert "--points.3.a" in told
    assert "mm" in told
    assert "deg" in told


BENCH = "bench=sim://generic-hpgl-600@generic-hpgl-600"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["design", "tuk"], "There is no family 'tuk'. There are:"),
        (["design", "tuck", "--preset", "stool"], "There is no preset of tuck 'stool'"),
        (["design", "tuck", "--n", "2"], "n must be at least 3"),
        (["design", "tuck", "--points.9.a", "5"], "numbered 1, 2, 3"),
        (["design", "tuck", "--colour", "red"], "There is no colour to set"),
        (["design", "tuck", "--phi"], "--phi needs a value"),
        (["design", "tuck", "--presets", "stool-n8"], "Did you mean --preset?"),
        (["desing", "tuck"], "Did you mean 'design'? `foldmill --help` tells what there is."),
        (["plan", "a.fold", "--width", "44cm", "-o", "job"], "in digits, without its unit."),
        (["plan", "a.fold", "--flip", "left", "-o", "job"], "'--flip': 'left' is not one of"),
        (["job", "submit", "jbo", "--plotter", BENCH, "--on", "bench"], "no job folder jbo here"),
        (["check", "."], ".: is a directory. Name a file in it."),
        (["design", "tuck", "--phi", "NaN"], "phi must be"),
        (["design", "tuck", "-o", "stool.dwg"], "write .fold .svg .png .glb .stl or .obj"),
        (["check", "nothing.fold"], "nothing.fold: no such file or directory. Check its name"),
        (["plan", "bad.fold", "-o", "job"], "bad.fold"),
        (["plan", "a.fold", "-o", "job", "--material", "oak"], "There is no material 'oak'"),
        (["plan", "a.fold", "-o", "job", "--machine", "x"], "There is no machine 'x'"),
        (["machines", "--show", "grbl-lazer"], "Did you mean 'grbl-laser'?"),
        (["plan", "a.fold", "-o", "job", "--blank", "big"], "write WIDTHxHEIGHT in mm"),
        (["plan", "a.fold", "-o", "job", "--blank", "50x50"], "mm are missing"),
        (["plan", "a.fold", "-o", "job", "--copies", "0"], "'--copies': it must be at least 1."),
        (["plan", "a.fold", "-o", "job", "--to", ","], "--to names no format"),
        (["plan", "a.fold", "-o", "job", "--to", "dwg"], "There is no format 'dwg'"),
        (["verify", "nowhere"], "nowhere"),
        (["send", "nowhere", "--port", "sim://generic-hpgl-600"], "nowhere"),
        (["simulate"], "--pty LINK, --tcp PORT or --rfc2217 PORT"),
        (["simulate", "--tcp", "70000"], "'70000' is no port number from 1 to 65535"),
        (["plan", "a.fold", "-o", "bad.fold"], "bad.fold: file exists."),
        (["design", "rotational", "-o", "bad.fold/x.fold"], "bad.fold"),
        (["report", "rotational", "weight"], "There is no report of rotational 'weight'"),
        (["motion", "a.fold", "-o", "m.mp4"], "a motion is written as .fold .glb .gif or .webp"),
        (["motion", "a.fold", "--motion", "dance", "-o", "m.gif"], "There is no motion 'dance'"),
        (["motion", "a.fold", "--steps", "0", "-o", "m.gif"], "--steps must be from 1"),
        (["motion", "tuck", "-o", "m.gif"], "no motion that is known"),
        (["show", "a.fold", "-o", "a.gif"], "a picture is written as .png"),
    ],
)
def test_wrong_input_gets_one_sentence_and_leaves_nothing_behind(
    foldmill: Run, words: list[str], sentence: str
) -> None:
    Path("bad.fold").write_text("{ not json")
    foldmill("design", "rotational", "-o", "a.fold")
    before = sorted(Path().iterdir())
    told = foldmill(*words)
    assert told.code == 2
    assert sentence in told.err
    assert "Traceback" not in told.err
    assert sorted(Path().iterdir()) == before


def test_a_report_tells_where_a_form_is_free(foldmill: Run) -> None:
    told = json.loads(foldmill("report", "rotational", "free-phi", "--phi", "100", "--json").out)
    assert told["free_at_phi"] is True
    assert any(low < 100 < high for low, high in told["free_deg"])
    shut = json.loads(foldmill("report", "rotational", "free-phi", "--phi", "20", "--json").out)
    assert shut["free_at_phi"] is False
    impossible = foldmill("report", "rotational", "free-phi", "--points.1.a", "5000")
    assert impossible.code == 2
    assert "Point 3 must lie farther out" in impossible.err


def test_a_report_with_rows_is_a_table_for_people_and_a_list_for_machines(foldmill: Run) -> None:
    words = ("report", "six-crease", "flat-foldability", "--preset", "cup")
    told = foldmill(*words)
    assert told.code == 0
    head, *rows = told.out.split("\n\n")[1].splitlines()
    assert " ".join(head.split()) == "point folded flat kawasaki deg M minus V verdict"
    assert [row.split()[0] for row in rows] == ["3", "4", "5", "6", "7"]
    points = json.loads(foldmill(*words, "--json").out)["points"]
    assert [point["M_minus_V"] for point in points] == [2, -2, 2, -2, 2]
    freedoms = json.loads(foldmill("report", "six-crease", "freedoms", "--json").out)
    assert (freedoms["freedoms_open_sheet"], freedoms["freedoms_glued_tube"]) == (43, 34)


def test_dihedral_angles_of_a_vertex_are_written_as_a_table_and_as_a_plot(foldmill: Run) -> None:
    words = ("motion", "six-crease", "--preset", "cup", "--dihedral", "17", "--steps", "4")
    assert "creases at vertex 17: 6, 4 steps" in foldmill(*words, "-o", "a.csv").out
    head, *rows = Path("a.csv").read_text("utf-8").splitlines()
    assert head.startswith("t,folding rate FR (%),17-19 M (deg),")
    assert [row.split(",")[1] for row in rows] == ["0", "25", "50", "75", "100"]
    said = json.loads(foldmill(*words, "-o", "a.png", "--json").out)
    assert Path("a.png").read_bytes().startswith(b"\x89PNG")
    assert said["deg"][0][0] == pytest.approx(float(rows[0].split(",")[2]), abs=1e-6)
    assert foldmill(*words, "-o", "a.svg").code == 0
    assert foldmill("motion", "rotational", "--dihedral", "3", "-o", "r.csv").code == 0
    assert Path("r.csv").read_text("utf-8").startswith("t,3-")


@pytest.mark.parametrize(
    ("vertex", "file", "sentence"),
    [
        ("94", "a.png", "There is no vertex 94; the pattern has 0 to 93."),
        ("-1", "a.png", "There is no vertex -1; the pattern has 0 to 93."),
        ("99", "a.png", "Vertex 99 has no crease, only edges of the outline; take one inside."),
        ("17", "a.gif", "a.gif: dihedral angles are written as .csv .png or .svg."),
    ],
)
def test_a_vertex_without_dihedral_angles_is_refused_with_a_sentence(
    foldmill: Run, vertex: str, file: str, sentence: str
) -> None:
    more = ("--tab", "2") if vertex == "99" else ()
    told = foldmill("motion", "six-crease", "--dihedral", vertex, "-o", file, *more)
    assert (told.code, told.err) == (2, f"foldmill: {sentence}\n")
    assert not Path(file).exists()


def test_a_motion_is_written_as_frames_and_as_a_moving_picture(foldmill: Run) -> None:
    assert foldmill("motion", "rotational", "--phi", "70", "--steps", "4", "-o", "m.fold").code == 0
    told = json.loads(Path("m.fold").read_text())
    assert told["file_classes"] == ["animation"]
    assert len(told["file_frames"]) == 1 + 5
    assert foldmill("motion", "m.fold", "--steps", "3", "-o", "m.gif").code == 0
    assert foldmill("motion", "m.fold", "--steps", "3", "-o", "m.glb").code == 0
    assert Path("m.glb").read_bytes().startswith(b"glTF")
    assert Path("m.gif").read_bytes().startswith(b"GIF89a")


def test_an_edited_program_is_not_sent(foldmill: Run) -> None:
    foldmill("design", "tuck", "--preset", "stool-n8", "-o", "stool.fold")
    foldmill("plan", "stool.fold", "--to", "hpgl", "-o", "job")
    program = Path("job/2-front-score.hpgl")
    program.write_bytes(program.read_bytes().replace(b"PD", b"PU", 1))
    assert foldmill("verify", "job", "--picture", "wrong.png").code == 1
    assert Path("wrong.png").read_bytes().startswith(b"\x89PNG")
    told = foldmill("send", "job", "--port", "sim://generic-hpgl-600", "--yes")
    assert told.code == 2
    assert "does not verify" in told.err


def test_a_plan_with_an_error_of_its_own_is_written_and_told_but_not_sent(foldmill: Run) -> None:
    foldmill("design", "rotational", "--preset", "lampshade-n12", "-o", "a.fold")
    planned = foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    assert planned.code == 1
    assert "groove ends are wanted" in planned.out
    assert foldmill("verify", "job").code == 1
    told = foldmill("send", "job", "--port", "sim://generic-hpgl-600", "--yes")
    assert told.code == 2
    assert "groove ends are wanted" in told.err


def test_a_sheet_with_valleys_only_is_loaded_with_its_reverse_up(foldmill: Run) -> None:
    from foldmill import CreasePattern, Fold
    from foldmill.exchange import write

    corners = [[0, 0], [90, 0], [180, 0], [180, 90], [90, 90], [0, 90]]
    rim = [[k, (k + 1) % 6] for k in range(6)]
    fold = Fold(CreasePattern.from_lines(corners, [*rim, [1, 4]], "BBBBBBV"))
    Path("v.fold").write_text(write(fold))
    assert foldmill("plan", "v.fold", "--to", "hpgl", "-o", "job").code == 0
    url = "sim://valleys?machine=generic-hpgl-600"
    assert foldmill("send", "job", "--port", url, "--yes", "--draw", "cut").code == 0
    assert "set-up-1" not in Path("cut/front.svg").read_text()
    assert "set-up-1" in Path("cut/reverse.svg").read_text()


def test_a_job_is_not_sent_to_a_simulator_of_another_machine(foldmill: Run) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    told = foldmill("send", "job", "--port", "sim://generic-hpgl-pens", "--yes")
    assert told.code == 2
    assert "is made for generic-hpgl-600" in told.err


def test_a_folder_for_pictures_that_is_a_file_is_refused_before_anything_is_cut(
    foldmill: Run,
) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    told = foldmill("send", "job", "--port", "sim://generic-hpgl-600", "--yes", "--draw", "a.fold")
    assert told.code == 2
    assert "executed" not in told.out


def test_what_send_says_as_json_is_json(foldmill: Run) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    url = "sim://json?machine=generic-hpgl-600"
    told = foldmill("send", "job", "--port", url, "--yes", "--draw", "cut", "--json")
    assert len(json.loads(told.out)) == 4


@pytest.mark.parametrize("port", ["/dev/nothing-here", "foo://x", ""])
def test_a_port_that_is_not_there_is_told_before_a_sheet_is_loaded(
    foldmill: Run, port: str
) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    told = foldmill("send", "job", "--port", port)
    assert told.code == 2
    assert "Load" not in told.out + told.err


def test_an_unconfirmed_program_ends_the_job(foldmill: Run) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    told = foldmill("send", "job", "--port", "sim://generic-hpgl-600?fault=silence@6500", "--yes")
    assert told.code != 0
    assert "2-front-score" not in told.out


def test_a_signal_to_end_stops_the_machine_first() -> None:
    with pytest.raises(KeyboardInterrupt), stopping_on_signals():
        os.kill(os.getpid(), signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


def test_yes_is_refused_on_a_real_port(foldmill: Run) -> None:
    foldmill("design", "rotational", "-o", "a.fold")
    foldmill("plan", "a.fold", "--to", "hpgl", "-o", "job")
    told = foldmill("send", "job", "--port", "/dev/ttyUSB99", "--yes")
    assert told.code == 2
    assert "somebody has to load" in told.err


def test_a_job_fitted_to_marks_is_sent_and_a_wrong_reading_is_not(foldmill: Run) -> None:
    foldmill("design", "tuck", "--preset", "stool-n8", "-o", "stool.fold")
    foldmill("plan", "stool.fold", "--to", "hpgl", "-o", "job")
    send = ("send", "job", "--port", "sim://generic-hpgl-600", "--yes", "--pass", "reverse")
    good = foldmill(*send, "--marks", "60.9,539.2;539.9,539.2;80.9,80.2;519.9,80.2")
    assert "shift +0.40, -0.30 mm" in good.out
    assert good.out.count("executed") == 2
    bad = foldmill(*send, "--marks", "60.5,539.5;536.0,539.5")
    assert bad.code == 2
    assert "scale" in bad.err
    wrong_way = foldmill(*send, "--marks", "60.5,60.5;529.5,529.5")
    assert wrong_way.code == 2
    assert "Is the sheet turned left-right" in wrong_way.err
    assert "write x1,y1" in foldmill(*send, "--marks", "nan,539.5;539.5,539.5").err


HEAVY = {
    *("distributed", "ezdxf", "fastapi", "joblib", "matplotlib", "networkx", "numba", "numpy"),
    *("pikepdf", "pyarrow", "pydantic", "scipy", "serial", "shapely", "sqlalchemy", "trimesh"),
}


@pytest.mark.parametrize(
    ("words", "needed"),
    [
        (["--help"], set()),
        (["--version"], set()),
        (["plan", "--help"], {"pydantic"}),  # Typer asks it of a command's options
        (["job", "list", "--help"], {"pydantic"}),
        (["job", "list"], {"pydantic", "sqlalchemy"}),
        (["families"], {"numpy", "pydantic"}),
        (["machines"], {"numpy", "pydantic"}),
        (["design", "rotational", "-o", "a.fold"], {"numpy", "pydantic", "scipy", "shapely"}),
    ],
)
def test_a_command_loads_what_it_needs_and_nothing_else_that_is_heavy(
    words: list[str], needed: set[str], tmp_path: Path
) -> None:
    loaded = _loaded(words, tmp_path)
    assert loaded & HEAVY <= needed


def test_who_plans_programs_alone_waits_for_no_drawings_and_no_ledger(tmp_path: Path) -> None:
    lines = "IN;SP1;PU400,400;PD8000,400;PU8000,800;PD400,800;PU400,1200;PD8000,1200;PU;SP0;"
    (tmp_path / "a.plt").write_text(lines)
    loaded = _loaded(["plan", "a.plt", "--pen", "1=score", "--to", "hpgl", "-o", "job"], tmp_path)
    assert (tmp_path / "job" / "plan.json").exists()
    assert loaded & HEAVY <= {"matplotlib", "numpy", "pydantic", "scipy", "shapely"}
    assert "foldmill_fabricate.remaking" not in loaded


def _loaded(words: list[str], place: Path) -> set[str]:
    """Return the modules of a process that ran a command; it must have ended well."""
    code = (
        f"import sys; sys.argv = ['foldmill', *{words!r}]\n"
        "from foldmill_fabricate.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "print('LOADED', *sys.modules)"
    )
    env = {**os.environ, "PYTHONWARNINGS": "ignore"}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=env, cwd=place
    )
    assert "LOADED" in done.stdout, done.stdout + done.stderr
    return set(done.stdout.partition("LOADED")[2].split())


def test_the_version_is_told(foldmill: Run) -> None:
    told = foldmill("--version")
    assert (told.code, told.out) == (0, f"foldmill {version('foldmill')}\n")
