"""Every number of the identification that was chosen, and why.

`make settings` halves and doubles each on the same cases; `results/settings` shows what changes.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """correlation_time      s; errors of a model are taken as independent after this long: about
                          the period of a gait
    effect_prior          an effect's quantities are expected within so many of their usual sizes,
                          a value that is certainly wrong within so many of its sigmas
    least_process_noise   of the grid, half decades: less is as good as none
    most_process_noise    of the grid: segments are as good as independent
    stride                in scales; a step in a quantity is no longer
    tolerance             of the deviance, nats, at which a fit has converged
    trial_runs            those explained worst, on which initial guesses are tried
    trial_steps           Gauss-Newton steps of the better half of the guesses, of the better half
                          of those, and so on
    first_steps           of a fit, before the process noise is estimated
    patience              steps like its last one after which a fit that is still worse than another
                          is given up
    steps                 at most, for a fit
    negligible            RMS in sigma beyond the noise that the nominal model may leave
    none                  the same beside an effect, from which machines differ
    small                 share of the first excess misfit: what remains is small
    accounted             share of what is left without an effect that it has to account for
    slow                  Hz; what moves slower may be the machine, what is faster is noise
    shown                 of what is known of a combination of values: a recording that brings less
                          says nothing of it
    inconstant            by as large a factor, at most, an imitation's values vary more between
                          recordings than their uncertainty (mean square)
    form_errors           of an effect, by which what is left beside it is as likely an imitation's
                          as a machine's
    misstated             relative; a level of the noise that differs by more is not as stated
    correlated            as many samples worth one are more than white noise has by chance
    certain               chance of so much by noise, below which an unknown input is there
    most_effects          that are looked for at once; and values that may be wrong
    promising             candidates of a score test that are fitted, of one effect and of two
    evidence              nats by which an effect has to improve the predictions of recordings
    standard_errors       and by so many standard errors over recordings
    named                 confidence above which an effect is named
    false_alarm           chance that any value is called wrong where all are right
    identifiable          standard deviation over that believed, above which data say nothing

    Of machines:

    form_error            of the way travelled, and of the speed over a segment: by so much even a
                          fine simulation of wheels that press on a floor is off
    starting              s; after a start from rest the motor saturates, which is left out
    bouncing              of a period; after a start from rest a joint with play bounces between its
                          stops, how much nobody knows: its angle is left out
    creeping              s, in which a side speed of a wheel that creeps is gone
    growth                e^2: a window is no longer than errors take to grow so many times anywhere
    input_share           of the motion in the longest windows (RMS): the noise of the inputs leaves
                          no more than that in a window,
    input_noise           or than that RMS in sigma
    modes                 of the errors that a force left out makes in a window, beside those that
                          its start takes up
    windows               in a part of a recording that is predicted from the others
    """

    correlation_time: float = 1.0
    effect_prior: float = 10.0
    least_process_noise: float = 0.02
    most_process_noise: float = 1e3
    stride: float = 3.0
    tolerance: float = 0.05
    trial_runs: int = 2
    trial_steps: tuple[int, ...] = (1, 3)
    first_steps: int = 4
    patience: float = 10.0
    steps: int = 15
    negligible: float = 0.1
    none: float = 0.2
    small: float = 0.01
    accounted: float = 0.5
    slow: float = 2.0
    shown: float = 0.01
    inconstant: float = 100.0
    form_errors: float = 6.0
    misstated: float = 0.1
    correlated: float = 1.5
    certain: float = 1e-6
    most_effects: int = 3
    promising: int = 4
    evidence: float = 5.0
    standard_errors: float = 0.5
    named: float = 0.5
    false_alarm: float = 0.01
    identifiable: float = 0.999
    form_error: float = 1e-4
    starting: float = 0.05
    bouncing: float = 0.5
    creeping: float = 0.02
    growth: float = 7.4
    input_share: float = 0.005
    input_noise: float = 6.0
    modes: int = 4
    windows: int = 2


SETTINGS = Settings()
