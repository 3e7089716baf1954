// Reads an arm's numbers, as arms.py writes them, into a Pinocchio model.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

#include <pinocchio/multibody.hpp>

inline pinocchio::Model read_model(const char* path)
{
    std::ifstream file(path);
    file.exceptions(std::ifstream::failbit | std::ifstream::badbit);
    int joints;
    Eigen::Vector3d gravity;
    file >> joints >> gravity[0] >> gravity[1] >> gravity[2];

    pinocchio::Model model;
    model.gravity.linear() = gravity;
    Eigen::VectorXd armature(joints);
    pinocchio::JointIndex parent = 0;
    for (int i = 0; i < joints; ++i) {
        int kind, along;
        Eigen::Matrix3d rotation, inertia;
        Eigen::Vector3d place, com;
        double mass;
        const auto matrix = [&](Eigen::Matrix3d& m) { for (int k = 0; k < 9; ++k) file >> m(k / 3, k % 3); };
        const auto vector = [&](Eigen::Vector3d& v) { file >> v[0] >> v[1] >> v[2]; };
        file >> kind >> along;
        matrix(rotation);
        vector(place);
        file >> mass;
        vector(com);
        matrix(inertia);
        file >> armature[i];

        using namespace pinocchio;
        const JointModel revolute[] = {JointModelRX(), JointModelRY(), JointModelRZ()};
        const JointModel prismatic[] = {JointModelPX(), JointModelPY(), JointModelPZ()};
        const JointModel& joint = kind == 0 ? revolute[along] : prismatic[along];
        parent = model.addJoint(parent, joint, SE3(rotation, place), "joint" + std::to_string(i + 1));
        model.appendBodyToJoint(parent, Inertia(mass, com, inertia), SE3::Identity());
    }
    model.armature = armature;
    return model;
}
