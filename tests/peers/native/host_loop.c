/* The generated step in a loop of the host, at its own period, with absolute deadlines: how late the loop wakes up, and how
 * long one step takes.
 *
 *     host_loop SECONDS
 *
 * NAME is the module's name, UPPER the same in capital letters; HEADER is its header. In place of an arm the measurement is the
 * desired motion with a small error that moves. Exit code 1 if a step answers a fault. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>

#include HEADER

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define OF(what) JOIN(NAME, what)
#define N JOIN(UPPER, _JOINTS)

static const int64_t SECOND = 1000000000;

static int64_t now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * SECOND + time.tv_nsec;
}

/* Sleeps until an instant; does not sleep if it has passed, so that the loop catches up after a late step. */
static void sleep_until(int64_t deadline)
{
    const struct timespec time = {(time_t)(deadline / SECOND), (long)(deadline % SECOND)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL) != 0)
        ;
}

static int ascending(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Percentiles in microseconds: the smallest value that so many per cent of the values do not exceed. */
static void print(const char *title, int64_t *values, long count)
{
    static const double percentiles[] = {50, 90, 99, 99.9, 100};
    size_t i;
    qsort(values, (size_t)count, sizeof *values, ascending);
    printf("%-16s", title);
    for (i = 0; i < sizeof percentiles / sizeof *percentiles; i++)
        printf("%12.2f", (double)values[(long)ceil(percentiles[i] / 100 * (double)count) - 1] / 1e3);
    printf("\n");
}

/* Asks for what a control loop needs of the system, and says what was refused. */
static void prepare(void)
{
    struct sched_param priority;
    priority.sched_priority = sched_get_priority_max(SCHED_FIFO) - 1;
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        puts("memory is not locked: a page fault may delay a step");
    if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
        puts("no real-time priority: other programs may delay the loop");
}

int main(int count, char **arguments)
{
    const double period = JOIN(UPPER, _PERIOD), seconds = count == 2 ? atof(arguments[1]) : 0;
    const long ticks = (long)(seconds / period), rest = (long)(JOIN(UPPER, _DURATION) / period);
    const int64_t step = (int64_t)llround(period * 1e9);
    struct OF(_controller) controller;
    struct OF(_desired) desired;
    struct OF(_command) command;
    int64_t *late, *took, first;
    long tick, faults = 0, missed = 0;
    if (ticks < 1 || ticks > 100000000) {
        fputs("host_loop SECONDS: a number of seconds, at least one period\n", stderr);
        return 2;
    }
    late = calloc((size_t)ticks, sizeof *late);
    took = calloc((size_t)ticks, sizeof *took);
    if (late == NULL || took == NULL || OF(_init)(&controller) != JOIN(UPPER, _OK))
        return 2;
    prepare();
    first = now() + step;
    for (tick = 0; tick < ticks; tick++) {
        const int64_t deadline = first + tick * step;
        const double time = (double)(tick % (rest + 1)) * period;
        double q[N], qd[N];
        int64_t woken, done;
        int joint;
        sleep_until(deadline);
        woken = now();
        OF(_reference)(time, &desired);
        for (joint = 0; joint < N; joint++) {
            q[joint] = desired.q[joint] + 1e-3 * sin(10 * time + joint);
            qd[joint] = desired.qd[joint] + 1e-2 * cos(10 * time + joint);
        }
        /* A loop on a robot reads its sensors above and sends command.torque below. */
        done = now();
        faults += OF(_step)(&controller, q, qd, &desired, &command) != JOIN(UPPER, _OK);
        took[tick] = now() - done;
        late[tick] = woken - deadline;
        missed += now() - deadline > step;
    }
    printf("%d joints, %ld steps of %.0f us, %ld finished after the next deadline, %ld faults\n", (int)N, ticks,
           period * 1e6, missed, faults);
    printf("%-16s%12s%12s%12s%12s%12s\n", "microseconds", "50 %", "90 %", "99 %", "99.9 %", "largest");
    print("wakes up late by", late, ticks);
    print("one step takes", took, ticks);
    return faults != 0;
}
