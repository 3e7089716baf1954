// C code of the passivity torque by two of Pinocchio's inverse dynamics over CasADi's scalars.
//
//     pinocchio_casadi MODEL FILE.c      prints operations and CPU seconds as JSON
#include <pinocchio/autodiff/casadi.hpp>

#include <cstdio>
#include <ctime>
#include <filesystem>

#include <pinocchio/algorithm/rnea.hpp>

#include "model.hpp"

using casadi::SX;

static bool counts(casadi_int kind)
{
    switch (kind) {
    case casadi::OP_CONST:
    case casadi::OP_INPUT:
    case casadi::OP_OUTPUT:
    case casadi::OP_PARAMETER:
    case casadi::OP_ASSIGN:
    case casadi::OP_SIN:
    case casadi::OP_COS:
        return false;
    default:
        return true;
    }
}

int main(int, char** arguments)
{
    const pinocchio::Model numbers = read_model(arguments[1]);
    const std::clock_t start = std::clock();
    const pinocchio::ModelTpl<SX> model = numbers.cast<SX>();
    pinocchio::ModelTpl<SX> weightless = model;
    weightless.gravity.setZero();
    pinocchio::DataTpl<SX> data(model), second(weightless);

    using Vector = pinocchio::ModelTpl<SX>::ConfigVectorType;
    const auto symbols = [&](const SX& x) {
        Vector v(model.nv);
        for (int i = 0; i < model.nv; ++i) v[i] = x(i);
        return v;
    };
    const SX q = SX::sym("q", model.nv), qd = SX::sym("qd", model.nv);
    const SX v_r = SX::sym("v_r", model.nv), a_r = SX::sym("a_r", model.nv);
    const Vector zero = symbols(SX::zeros(model.nv));
    const Vector with = pinocchio::rnea(model, data, symbols(q), symbols((qd + v_r) / 2), symbols(a_r));
    const Vector without = pinocchio::rnea(weightless, second, symbols(q), symbols((qd - v_r) / 2), zero);
    SX tau = SX::zeros(model.nv);
    for (int i = 0; i < model.nv; ++i) tau(i) = with[i] - without[i];

    const casadi::Function function("passivity", {q, qd, v_r, a_r}, {tau});
    const std::filesystem::path path = arguments[2];
    function.generate(path.filename().string());
    std::filesystem::rename(path.filename(), path);
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;

    int operations = 0, trig = 0;
    for (casadi_int k = 0; k < function.n_instructions(); ++k) {
        const casadi_int kind = function.instruction_id(k);
        operations += counts(kind);
        trig += kind == casadi::OP_SIN || kind == casadi::OP_COS;
    }
    std::printf("{\"operations\": %d, \"trig\": %d, \"seconds\": %g}\n", operations, trig, seconds);
}
