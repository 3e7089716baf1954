/* One control period written by hand: quintic reference, law (34) of the report around an exact model, torque limits.
 *
 * With an exact model the bracket of (34) is a constant gain per joint. The gains are diagonal. The model is CasADi's code.
 * constants.h has N, the gains and the reference; it is written from the constants of the generated module. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "constants.h"

int passivity(const double** arg, double** res, long long int* iw, double* w, int mem);

typedef struct {
    double torque[N];
    int saturated[N];
} Command;

static Command last;

static int all_finite(const double* x)
{
    int all = 1;
    for (int i = 0; i < N; ++i) all &= isfinite(x[i]) != 0;
    return all;
}

static int hold(Command* command)
{
    *command = last;
    return 1;
}

static void reference(double t, double* q, double* qd, double* qdd)
{
    const double x = t <= 0 ? 0 : t >= DURATION ? 1 : t / DURATION, left = 1 - x;
    const double place = x * x * x * (10 + x * (6 * x - 15));
    const double speed = 30 / DURATION * (x * x) * (left * left);
    const double rise = 60 / (DURATION * DURATION) * x * left * (left - x);
    for (int i = 0; i < N; ++i) {
        const double span = TO[i] - FROM[i];
        q[i] = FROM[i] + span * place;
        qd[i] = span * speed;
        qdd[i] = span * rise;
    }
}

/* Zero, or one where a number is not finite: then the command is the last good one. */
static int step(const double* q, const double* qd, const double* q_d, const double* qd_d, const double* qdd_d,
                Command* command)
{
    double q_e[N], s[N], v_r[N], a_r[N];
    if (!(all_finite(q) & all_finite(qd) & all_finite(q_d) & all_finite(qd_d) & all_finite(qdd_d))) return hold(command);
    for (int i = 0; i < N; ++i) {
        const double qd_e = qd[i] - qd_d[i];
        q_e[i] = q[i] - q_d[i];
        s[i] = qd_e + P12[i] * q_e[i];
        v_r[i] = qd_d[i] - P12[i] * q_e[i];
        a_r[i] = qdd_d[i] - P12[i] * qd_e;
    }

    double tau[N];
    const double* arguments[4] = {q, qd, v_r, a_r};
    double* results[1] = {tau};
    passivity(arguments, results, NULL, NULL, 0);

    for (int i = 0; i < N; ++i) {
        tau[i] += VISCOUS[i] * qd[i] - DAMPING[i] * s[i] + PQQ[i] * q_e[i];
#if LAYER
        const double x = s[i] / PHI[i];
        tau[i] -= GAIN[i] * (x > 1 ? 1 : x < -1 ? -1 : x);
#elif ROBUST
        tau[i] -= GAIN[i] * (s[i] > 0 ? 1 : s[i] < 0 ? -1 : 0);
#endif
    }
    if (!all_finite(tau)) return hold(command);
    for (int i = 0; i < N; ++i) {
#if LIMITED
        command->saturated[i] = fabs(tau[i]) > LIMIT[i];
        tau[i] = tau[i] > LIMIT[i] ? LIMIT[i] : tau[i] < -LIMIT[i] ? -LIMIT[i] : tau[i];
#endif
        command->torque[i] = tau[i];
    }
    last = *command;
    return 0;
}

void prepare(const char* path)
{
    (void)path;
}

void measured(double t, const double* q, const double* qd, double* tau)
{
    double q_d[N], qd_d[N], qdd_d[N];
    Command command;
    reference(t, q_d, qd_d, qdd_d);
    step(q, qd, q_d, qd_d, qdd_d, &command);
    memcpy(tau, command.torque, sizeof command.torque);
}
