// A loop of four hinges by Pinocchio from C++, for `peers.py`: Gauss-Newton, each pose from the one before it.
//
// Standard input: the poses of the four hinges, 4x4 by rows, z the axis; the number of poses; the angles of the first
// hinge. Standard output: the angles of the other three, and behind them the seconds that all poses took.
#include <chrono>
#include <cstdio>
#include <vector>

#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>

namespace pin = pinocchio;

int main() {
  pin::Model model;
  pin::SE3 last = pin::SE3::Identity();
  pin::JointIndex joint = 0;
  for (int hinge = 0; hinge < 4; ++hinge) {
    double rows[16];
    if (std::fread(rows, sizeof(double), 16, stdin) != 16) return 1;
    const Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> pose(rows);
    const pin::SE3 placed(pose.topLeftCorner<3, 3>(), pose.topRightCorner<3, 1>());
    joint = model.addJoint(joint, pin::JointModelRZ(), last.actInv(placed), "hinge" + std::to_string(hinge));
    last = placed;
  }
  double count;
  if (std::fread(&count, sizeof(double), 1, stdin) != 1) return 1;
  const int poses = static_cast<int>(count);
  std::vector<double> angles(poses), found(3 * poses);
  if (std::fread(angles.data(), sizeof(double), poses, stdin) != static_cast<size_t>(poses)) return 1;

  pin::Data data(model);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(4);
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, 4);
  const pin::SE3 behind = last.inverse();
  const auto begin = std::chrono::steady_clock::now();
  for (int pose = 0; pose < poses; ++pose) {
    q[0] = angles[pose];
    for (int step = 0; step < 20; ++step) {
      pin::computeJointJacobians(model, data, q);
      const pin::SE3 end = data.oMi[joint] * behind;  // the last link is the ground: it has to come back
      const Eigen::Matrix<double, 6, 1> off = pin::log6(end).toVector();
      if (off.norm() < 1e-11) break;
      jacobian.setZero();
      pin::getJointJacobian(model, data, joint, pin::WORLD, jacobian);
      const Eigen::Matrix<double, 6, 1> twist = end.toActionMatrix() * off;
      const Eigen::Matrix<double, 6, 3> free = jacobian.rightCols<3>();
      q.tail<3>() -= (free.transpose() * free).ldlt().solve(free.transpose() * twist);
    }
    for (int k = 0; k < 3; ++k) found[3 * pose + k] = q[k + 1];
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::fwrite(found.data(), sizeof(double), found.size(), stdout);
  std::fwrite(&seconds, sizeof(double), 1, stdout);
  return 0;
}
