"""Every tuning constant of the identification, and why it was chosen.

`make settings` halves and doubles each on the same cases; `results/settings` shows what changes.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """correlation_time      s after which a model's errors count as independent: about a period
    effect_prior          prior standard deviation of an effect's quantities, in their usual sizes;
                          and of a value known to be wrong, in its stated sigmas
    least_process_noise   lower end of the grid: anything less is as good as none
    most_process_noise    upper end of the grid, which has half decades: segments are independent
    stride                longest step in a quantity, in its scales
    tolerance             expected gain of a step, in nats of deviance, below which the fit has
                          converged: its values are within a thirtieth of a standard deviation
    search_tolerance      the same for candidates: a twenty-fifth of what counts as evidence
    known                 share of the negligible level to which misfits of whole runs are known
    known_share           share of itself to which that of a fit is: slow creep is not followed
    trial_runs            number of runs, the worst explained ones, on which guesses are tried; all
                          if every run is explained to within chance
    trial_starts          number of guesses kept after one Gauss-Newton step
    trial_steps           further steps taken from these: a narrow minimum shows late
    first_steps           steps of a fit before the process noise is estimated
    patience              a fit that is behind another is given up unless this many steps like its
                          last one would catch up
    steps                 most steps of a fit
    negligible            RMS misfit beyond the noise, in sigma, allowed to the nominal model
    none                  the same with effects, as no machine matches the model of an effect
    small                 share of the initial excess misfit below which a remainder is small
    slow                  Hz, below which motion may be the machine's; above it is noise
    shown                 share of the total information on a combination of values below which a
                          recording says nothing about it
    inconstant            largest factor by which an imitation's values vary more between recordings
                          than their uncertainty (mean square)
    further               prior odds of each further effect that the motion alone shows: several can
                          imitate anything
    form_errors           multiples of an effect's form error at which a remainder is as likely an
                          imitation's as a machine's
    removed               multiples of the other effects' form error that a further effect has to
                          remove to be kept, unless nothing is left with it: a level of 95 %
    misstated             relative deviation from the stated noise level that contradicts it
    correlated            samples per independent sample beyond which noise is not white by chance
    certain               p-value below which an unknown input is significant
    most_effects          most effects sought at once, and most values that may be wrong
    promising             candidates fitted after a score test, of one effect and of two
    evidence              nats by which an effect has to improve the predictions of recordings,
    standard_errors       and by how many standard errors of that improvement over recordings
    named                 confidence above which an effect is named
    false_alarm           chance that any value is called wrong when all are right

    Of machines:

    form_error            error of even a fine simulation of wheels pressed on a floor, as a share
                          of the distance travelled and of a segment's speed
    starting              s left out after a start from rest: the motor saturates
    bouncing              share of a period after a start from rest for which the joint's angle is
                          left out: with backlash the joint bounces between stops unpredictably
    creeping              s in which the side speed of a creeping wheel decays: at the start of a
                          run, it is known to what moves a wheel within that time by the noise
    growth                factor by which errors may grow within a window: e^2
    input_share           error that input noise may cause in a window: this share of the
                          motion in the longest windows (RMS),
    input_noise           or this RMS in sigma
    modes                 error modes that a missing force causes in a window, beside those that
                          its initial state absorbs
    windows               windows in a part of a recording that is predicted from the others
    grips                 shares of the largest grip needed at which sliding is tried, from almost
                          enough to hardly any
    creeps                creep that is tried beside it, in usual sizes: wheels with hardly any grip
                          creep easily, and from there a fit sees more of the sliding
    slips                 guesses of sliding that are fitted, the best ones
    largest_share         of the change that a guess makes; more is another guess's, as it is not in
                          proportion
    """

    correlation_time: float = 1.0
    effect_prior: float = 10.0
    least_process_noise: float = 0.02
    most_process_noise: float = 1e3
    stride: float = 3.0
    tolerance: float = 0.001
    search_tolerance: float = 0.2
    known: float = 0.05
    known_share: float = 0.01
    trial_runs: int = 2
    trial_starts: int = 6
    trial_steps: int = 4
    first_steps: int = 4
    patience: float = 10.0
    steps: int = 15
    negligible: float = 0.1
    none: float = 0.2
    small: float = 0.01
    slow: float = 2.0
    shown: float = 0.01
    inconstant: float = 100.0
    further: float = 0.25
    form_errors: float = 6.0
    removed: float = 2.0
    misstated: float = 0.1
    correlated: float = 1.5
    certain: float = 1e-6
    most_effects: int = 3
    promising: int = 4
    evidence: float = 5.0
    standard_errors: float = 0.5
    named: float = 0.5
    false_alarm: float = 0.01
    form_error: float = 1e-4
    starting: float = 0.05
    bouncing: float = 0.5
    creeping: float = 0.02
    growth: float = 7.4
    input_share: float = 0.005
    input_noise: float = 6.0
    modes: int = 4
    windows: int = 2
    grips: tuple[float, ...] = (0.95, 0.6, 0.2, 0.03)
    creeps: tuple[float, ...] = (0.3, 30.0, 300.0)
    slips: int = 3
    largest_share: float = 1.5


SETTINGS = Settings()
