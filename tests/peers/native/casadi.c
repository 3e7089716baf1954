/* Passivity torque by the C code that CasADi has made. */
#include <stddef.h>

int passivity(const double** arg, double** res, long long int* iw, double* w, int mem);
int passivity_work(long long int* arg, long long int* res, long long int* iw, long long int* w);

void prepare(const char* path)
{
    (void)path;
}

void measured(int n, const double* q, const double* qd, const double* v_r, const double* a_r, double* tau)
{
    const double* arguments[4] = {q, qd, v_r, a_r};
    double* results[1] = {tau};
    (void)n;
    passivity(arguments, results, NULL, NULL, 0);
}
