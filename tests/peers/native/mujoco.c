/* MuJoCo: the passivity torque by two passes of mj_rne, or, with INVERSE, mj_inverse, which knows no v_r. */
#include <mujoco/mujoco.h>
#include <stdlib.h>

static mjModel* model;
static mjData* data;

void prepare(const char* path)
{
    model = mj_loadModel(path, NULL);
    if (!model) exit(2);
    data = mj_makeData(model);
}

#ifdef INVERSE
void measured(int n, const double* q, const double* qd, const double* v_r, const double* a_r, double* tau)
{
    (void)v_r;
    mju_copy(data->qpos, q, n);
    mju_copy(data->qvel, qd, n);
    mju_copy(data->qacc, a_r, n);
    mj_inverse(model, data);
    mju_copy(tau, data->qfrc_inverse, n);
}
#else
void measured(int n, const double* q, const double* qd, const double* v_r, const double* a_r, double* tau)
{
    double weightless[16];
    const double weight[3] = {model->opt.gravity[0], model->opt.gravity[1], model->opt.gravity[2]};
    mju_copy(data->qpos, q, n);
    mj_kinematics(model, data);
    mj_comPos(model, data);
    for (int i = 0; i < n; ++i) data->qvel[i] = 0.5 * (qd[i] + v_r[i]);
    mju_copy(data->qacc, a_r, n);
    mj_comVel(model, data);
    mj_rne(model, data, 1, tau);
    mju_zero3(model->opt.gravity);
    for (int i = 0; i < n; ++i) data->qvel[i] = 0.5 * (qd[i] - v_r[i]);
    mj_comVel(model, data);
    mj_rne(model, data, 0, weightless);
    mju_copy3(model->opt.gravity, weight);
    /* mj_rne leaves the rotors to its caller. */
    for (int i = 0; i < n; ++i) tau[i] += model->dof_armature[i] * a_r[i] - weightless[i];
}
#endif
