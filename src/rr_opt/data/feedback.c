/* The controller of a Roller Racer's route, written by rr-opt {{ version }}.
 *
 *     rr_route r;
 *     rr_route_begin(&r);
 *     do {
 *         for t from 0 to r.segment[7]: send rr_route_angle(&r, t) to the servo
 *     } while (rr_route_next(&r, x, y, psi));
 *
 * The angle is phi, from platform 1 to platform 2, in rad, at t s into a period. x, y (m) and psi
 * (rad) are the place of the joint P and the heading of platform 1 as they were {{ c.delay }} s before
 * the end of the period.
 */
#ifndef RR_ROUTE_H
#define RR_ROUTE_H

#include <math.h>

#define RR_PERIODS {{ c.F|length }}
#define RR_HOLD {{ c.hold }} /* the period that is repeated until the robot is at rest */
#define RR_LOOKS {{ constants.LOOKS }} /* places in a period where the limits are kept */

/* Angle (rad), rate (rad/s) and acceleration (rad/s2). */
static const double rr_limit[3] = {{ array(c.limits * constants.MARGIN) }};
/* Of each period: amplitude and offset (rad) and frequency (rad/s) at its beginning and its end,
 * phase (rad) at its beginning, duration (s). */
static const double rr_segment[RR_PERIODS][8] = {{ array(c.command.segments.T) }};
/* Where periods begin: pose, speed, the number that those alike share, the cost to go. */
static const double rr_place[RR_PERIODS + 1][3] = {{ array(c.place) }};
static const double rr_speed[RR_PERIODS + 1] = {{ array(c.speed) }};
static const int rr_group[RR_PERIODS + 1] = {{ array(c.group) }};
static const double rr_value[RR_PERIODS + 1][9][9] = {{ array(c.value) }};
/* The map of each period, linear but for the last of F and H, by the product of speed and lack of
 * friction; where the robot is seen; the filter; the regulator. */
static const double rr_F[RR_PERIODS][4][9] = {{ array(c.F) }};
static const double rr_B[RR_PERIODS][4][2] = {{ array(c.B) }};
static const double rr_seen[RR_PERIODS][3] = {{ array(c.seen) }};
static const double rr_H[RR_PERIODS][3][9] = {{ array(c.H) }};
static const double rr_G[RR_PERIODS][3][2] = {{ array(c.G) }};
static const double rr_L[RR_PERIODS][6][3] = {{ array(c.L) }};
static const double rr_gain[RR_PERIODS][2][9] = {{ array(c.gain) }};

/* A drive under way: z and u are the estimate and the corrections, segment is what the joint makes,
 * in the order of rr_segment. */
typedef struct {
    int period, made;
    double z[9], u[2], segment[8];
} rr_route;

/* Angle, rate and acceleration at a share s of a segment. */
static void rr_blended(double s, const double g[8], double out[3])
{
    double D = g[7], h = s * s * (3 - 2 * s), dh = 6 * s * (1 - s) / D, ddh = 6 * (1 - 2 * s) / (D * D);
    double w = g[2] + (g[5] - g[2]) * s, theta = g[6] + D * s * (g[2] + w) / 2;
    double wave = sin(theta), along = cos(theta);
    double A = g[0] + (g[3] - g[0]) * h, dA = (g[3] - g[0]) * dh, ddA = (g[3] - g[0]) * ddh;
    out[0] = g[1] + (g[4] - g[1]) * h + A * wave;
    out[1] = (g[4] - g[1]) * dh + dA * wave + A * w * along;
    out[2] = (g[4] - g[1]) * ddh + ddA * wave + 2 * dA * w * along
        + A * ((g[5] - g[2]) / D * along - w * w * wave);
}

double rr_route_angle(const rr_route *r, double t)
{
    double out[3];
    rr_blended(t / r->segment[7], r->segment, out);
    return out[0];
}

/* A pose in the frame of another. */
static void rr_apart(const double pose[3], const double planned[3], double out[3])
{
    double c = cos(planned[2]), s = sin(planned[2]);
    double dx = pose[0] - planned[0], dy = pose[1] - planned[1];
    out[0] = c * dx + s * dy;
    out[1] = c * dy - s * dx;
    out[2] = remainder(pose[2] - planned[2], 2 * acos(-1.0));
}

/* The amplitude and offset nearest to those wanted with which a segment keeps the limits. */
static void rr_within(double g[8], double A, double o)
{
    int part, i, k;
    for (part = {{ constants.WAYS_BACK }}; part >= 0; part--) {
        double low = 0, high = HUGE_VAL;
        double none[8] = {g[0], g[1], g[2], 0, g[1] + (o - g[1]) * part / {{ constants.WAYS_BACK }}, g[5], g[6], g[7]};
        double unit[8] = {0, 0, g[2], 1, 0, g[5], g[6], g[7]};
        for (i = 0; i <= RR_LOOKS; i++) {
            double rest[3], slope[3];
            rr_blended((double)i / RR_LOOKS, none, rest);
            rr_blended((double)i / RR_LOOKS, unit, slope);
            for (k = 0; k < 3; k++) {
                double by = fabs(slope[k]) < 1e-9 ? 1e-9 : slope[k];
                double a = (rr_limit[k] - rest[k]) / by, b = (-rr_limit[k] - rest[k]) / by;
                low = fmax(low, fmin(a, b));
                high = fmin(high, fmax(a, b));
            }
        }
        g[3] = fmax(0, fmin(fmax(A, low), high));
        if (low <= high || part == 0) {
            g[4] = none[4];
            return;
        }
    }
}

/* An estimate with the speed as one with which the planned robot would coast as far. */
static void rr_coasted(const double z[9], double out[9])
{
    int i;
    double far = 1 / fmax(1 - z[4], {{ constants.SLIPPERY }});
    for (i = 0; i < 9; i++)
        out[i] = i == 3 ? z[3] * far : i == 4 ? far - 1 : z[i];
}

/* An estimate with speed times lack of friction in place of the constant. */
static void rr_with_product(const double z[9], double out[9])
{
    int i;
    for (i = 0; i < 9; i++)
        out[i] = i < 8 ? z[i] : z[3] * z[4];
}

static void rr_enter(rr_route *r)
{
    int i, j, k = r->period;
    double wanted[2], z[9];
    rr_coasted(r->z, z);
    for (i = 0; i < 8; i++)
        r->segment[i] = rr_segment[k][i];
    for (i = 0; i < 2; i++) {
        r->segment[i] += r->u[i];
        wanted[i] = r->segment[3 + i];
        for (j = 0; j < 9; j++)
            wanted[i] -= rr_gain[k][i][j] * z[j];
    }
    rr_within(r->segment, wanted[0], wanted[1]);
    for (i = 0; i < 2; i++)
        r->u[i] = r->segment[3 + i] - rr_segment[k][3 + i];
}

void rr_route_begin(rr_route *r)
{
    int i;
    r->period = r->made = 0;
    r->u[0] = r->u[1] = 0;
    for (i = 0; i < 9; i++)
        r->z[i] = i == 8;
    rr_enter(r);
}

/* 1, and the segment after a pose; 0 at the end of the drive. */
int rr_route_next(rr_route *r, double x, double y, double psi)
{
    int i, j, k = r->period, begin = k + 1, late, moves;
    double pose[3] = {x, y, psi}, surprise[3], moved[4], here[9], whole[9], best = HUGE_VAL;
    rr_apart(pose, rr_seen[k], surprise);
    rr_with_product(r->z, whole);
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 9; j++)
            surprise[i] -= rr_H[k][i][j] * whole[j];
        surprise[i] -= rr_G[k][i][0] * r->u[0] + rr_G[k][i][1] * r->u[1];
    }
    for (i = 0; i < 6; i++)
        for (j = 0; j < 3; j++)
            r->z[i] += rr_L[k][i][j] * surprise[j];
    rr_with_product(r->z, whole);
    for (i = 0; i < 4; i++) {
        moved[i] = rr_B[k][i][0] * r->u[0] + rr_B[k][i][1] * r->u[1];
        for (j = 0; j < 9; j++)
            moved[i] += rr_F[k][i][j] * whole[j];
    }
    for (i = 0; i < 9; i++)
        here[i] = i < 4 ? moved[i] : i == 6 || i == 7 ? r->u[i - 6] : r->z[i];
    /* Go on with the next period, or with one that is alike and better; coast on until at rest. */
    pose[0] = rr_place[begin][0] + cos(rr_place[begin][2]) * here[0] - sin(rr_place[begin][2]) * here[1];
    pose[1] = rr_place[begin][1] + sin(rr_place[begin][2]) * here[0] + cos(rr_place[begin][2]) * here[1];
    pose[2] = rr_place[begin][2] + here[2];
    late = ++r->made >= {{ constants.LONGEST }} * RR_PERIODS;
    moves = fabs(rr_speed[begin] + here[3]) > {{ c.rest }};
    for (k = 0; k <= RR_PERIODS; k++) {
        int alike = rr_group[begin] && rr_group[k] == rr_group[begin] && (k > begin || !late);
        double z[9], cost;
        if (begin == RR_HOLD + 1 && moves && !late ? k != RR_HOLD : k != begin && !alike)
            continue;
        for (i = 0; i < 9; i++)
            z[i] = here[i];
        rr_apart(pose, rr_place[k], z);
        z[3] += rr_speed[begin] - rr_speed[k];
        cost = {{ constants.PERIOD }} * (RR_PERIODS - k);
        rr_coasted(z, whole);
        for (i = 0; i < 9; i++)
            for (j = 0; j < 9; j++)
                cost += whole[i] * rr_value[k][i][j] * whole[j];
        if (cost < best) {
            best = cost;
            r->period = k;
            for (i = 0; i < 9; i++)
                r->z[i] = z[i];
        }
    }
    if (r->period == RR_PERIODS)
        return 0;
    rr_enter(r);
    return 1;
}

#endif
