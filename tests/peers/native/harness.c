/* Runs measured() of one implementation over all states.
 *
 *     harness MODEL STATES JOINTS torques      prints one torque a line
 *     harness MODEL STATES JOINTS count        calls once for each state, for callgrind
 *     harness MODEL STATES JOINTS time         for each line of standard input, a number of rounds: ns a call
 *
 * A state is q, q̇, v_r, a_r; with STEP it is t, q, q̇.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void prepare(const char* path);
#ifdef STEP
void measured(double t, const double* q, const double* qd, double* tau);
#define WIDTH (1 + 2 * n)
#else
void measured(int n, const double* q, const double* qd, const double* v_r, const double* a_r, double* tau);
#define WIDTH (4 * n)
#endif

static double* states;
static size_t count;
static int n;
static volatile double sink;

static void read_states(const char* path)
{
    FILE* file = fopen(path, "r");
    size_t room = 1 << 16, read = 0;
    if (!file) exit(2);
    states = malloc(room * sizeof *states);
    while (fscanf(file, "%lf", &states[read]) == 1)
        if (++read == room) states = realloc(states, (room *= 2) * sizeof *states);
    fclose(file);
    count = read / WIDTH;
}

static void call(size_t k, double* tau)
{
    const double* state = states + WIDTH * k;
#ifdef STEP
    measured(state[0], state + 1, state + 1 + n, tau);
#else
    measured(n, state, state + n, state + 2 * n, state + 3 * n, tau);
#endif
}

static void pass(void)
{
    double tau[16];
    for (size_t k = 0; k < count; ++k) {
        call(k, tau);
        sink = tau[0];
    }
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * t.tv_sec + t.tv_nsec;
}

int main(int arguments, char** argument)
{
    if (arguments != 5) return 2;
    n = atoi(argument[3]);
    read_states(argument[2]);
    prepare(argument[1]);
    if (!strcmp(argument[4], "torques")) {
        double tau[16];
        for (size_t k = 0; k < count; ++k) {
            call(k, tau);
            for (int i = 0; i < n; ++i) printf("%.17g%c", tau[i], i + 1 < n ? ' ' : '\n');
        }
    } else if (!strcmp(argument[4], "count")) {
        pass();
    } else {
        int rounds;
        while (scanf("%d", &rounds) == 1) {
            const double start = now();
            for (int r = 0; r < rounds; ++r) pass();
            printf("%.17g\n", (now() - start) / ((double)rounds * count));
            fflush(stdout);
        }
    }
    return 0;
}
