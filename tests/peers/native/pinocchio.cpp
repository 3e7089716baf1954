// Passivity torque by two of Pinocchio's inverse dynamics in double.
#include <pinocchio/algorithm/rnea.hpp>

#include <cstdlib>

#include "model.hpp"

struct Pair {
    pinocchio::Model with, without;
    pinocchio::Data first, second;
    Eigen::VectorXd zero;

    explicit Pair(const pinocchio::Model& model)
        : with(model), without(model), first(model), second(model), zero(Eigen::VectorXd::Zero(model.nv))
    {
        without.gravity.setZero();
    }
};

static Pair* arm;
static Eigen::VectorXd plus, minus;

extern "C" void prepare(const char* path)
{
    arm = new Pair(read_model(path));
    plus = minus = arm->zero;
}

extern "C" void measured(int n, const double* q, const double* qd, const double* v_r, const double* a_r, double* tau)
{
    using Vector = Eigen::Map<const Eigen::VectorXd>;
    const Vector position(q, n), velocity(qd, n), reference(v_r, n), acceleration(a_r, n);
    plus = 0.5 * (velocity + reference);
    minus = 0.5 * (velocity - reference);
    const Eigen::VectorXd& with = pinocchio::rnea(arm->with, arm->first, position, plus, acceleration);
    const Eigen::VectorXd& without = pinocchio::rnea(arm->without, arm->second, position, minus, arm->zero);
    Eigen::Map<Eigen::VectorXd>(tau, n) = with - without;
}
