"""Robots that several tests drive."""

from dataclasses import replace

from rr_opt.model.robot import EffectUse, Platform, Robot

BENCHMARK = Robot(
    Platform(m=0.469, I=0.00386, c=0.236, a=0.05, b=0.05, kappa=0.05 * 0.02**2),
    Platform(m=0.25, I=0.3 * 0.00386, c=0.0941, a=0.05, b=0.05, kappa=0.05 * 0.02**2),
    h=0.02,
)

DRY = replace(
    BENCHMARK, physics=(EffectUse("coulomb_friction", {"force1": 0.002, "force2": 0.002}),)
)


def with_friction(k: float) -> Robot:
    """The benchmark robot with viscous friction k, N s/m per wheel."""
    kappa = k * BENCHMARK.h**2
    return replace(
        BENCHMARK,
        platform1=replace(BENCHMARK.platform1, kappa=kappa),
        platform2=replace(BENCHMARK.platform2, kappa=kappa),
    )
