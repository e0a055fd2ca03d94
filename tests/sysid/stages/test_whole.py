"""A diagnosis tells where the fault sits: the stage is lit, and the channel is that of the name."""

from rr_opt.machines.racer.diagnose import diagnose_racer
from tests.sysid.stages.world import recorded


def test_a_tilted_floor_is_named_and_its_stage_is_lit():
    tilt = {"floor_tilt.tilt_x": 0.001, "floor_tilt.tilt_y": -0.0005}
    found = diagnose_racer(recorded(tilt, seed=1))
    assert [one.name for one in found.findings] == ["floor_tilt"]
    assert found.channel == "floor"
    assert [stage.channel for stage in found.stages if stage.guilty] == ["floor"]
    assert "heading" in found.where
    assert found.seconds["where"] > 0
