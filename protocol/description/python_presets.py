"""The presets of the Python package, and those of evaluation in the packages that read plans and logs."""

from regions import with_region

PRESETS = "clients/python/racebeam/presets.py"
SUBMISSION = "clients/python/racebeam/single/submission.py"
PLAN = "evaluation/racebeam_evaluation/plan.py"


def table(name, rows):
    """A dictionary with a row a line."""
    return f"{name} = {{\n" + "".join(f'    "{key}": {value},\n' for key, value in rows) + "}\n"


def preset_call(preset):
    """The `Preset` of the Python package: four settings that every preset has, and by name those that few have."""
    words = preset.settings
    values = [words["frame_skip"], repr(float(words["sticky"])), str(words["action_set"] == "full")]
    values.append(words["max_episode_frames"])
    if "life_loss" in words:
        values.append(f'life_loss="{words["life_loss"]}"')
    if "noop_max" in words:
        values.append(f"noop_max={words['noop_max']}")
    if "reward_min" in words:
        values.append(f"reward_range=({words['reward_min']}, {words['reward_max']})")
    return f"Preset({', '.join(values)})"


def quoted(values):
    return "(" + ", ".join(f'"{value}"' for value in values) + ")"


def log_settings(preset):
    """The settings of a preset without no-ops, as the values that a log has."""
    words = preset.settings
    return (
        f'({words["frame_skip"]}, {float(words["sticky"])!r}, "{words["action_set"]}", {words["max_episode_frames"]})'
    )


def files(protocol, read):
    evaluation = protocol.evaluation_presets
    bodies = {
        PRESETS: (
            "presets",
            [("ale", "Preset()"), *((preset.name, preset_call(preset)) for preset in protocol.presets)],
        ),
        PLAN: ("evaluation presets", [(preset.name, quoted(preset.settings.values())) for preset in evaluation]),
        SUBMISSION: (
            "evaluation presets",
            [(one.name, log_settings(one)) for one in evaluation if one.settings["noop_max"] == "0"],
        ),
    }
    return {
        path: with_region(read(path), "", "#", name, table("PRESETS", rows)) for path, (name, rows) in bodies.items()
    }
