#include "integrators/centre_crossing.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

/// Pieces of the cubic through the ends of a step.
constexpr int kPieces = 8;

/// The cubic through the positions and velocities at the ends of a step of h at the fraction s.
Eigen::Vector2d on_the_way(double h, const dynamics::Obstacles::Motion& from, const dynamics::Obstacles::Motion& to,
                           double s) {
  const double r = 1.0 - s;
  return r * r * ((1.0 + 2.0 * s) * from.d + s * h * from.v) + s * s * ((1.0 + 2.0 * r) * to.d - r * h * to.v);
}

/// The distance of a point from the line between two others.
double distance_to_line(const Eigen::Vector2d& point, const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  const Eigen::Vector2d way = end - begin;
  const double square = way.squaredNorm();
  const double s = square > 0.0 ? std::clamp(way.dot(point - begin) / square, 0.0, 1.0) : 0.0;
  return (begin + s * way - point).norm();
}

}  // namespace

CentreCrossing::CentreCrossing(dynamics::Dynamics& dynamics) : obstacles_(dynamics.obstacles()) {
  if (obstacles_ != nullptr) pulls_ = dynamics::centre_pulls(*obstacles_);
  if (!pulls_.empty()) mass_ = dynamics.system().mass.diagonal();
}

double CentreCrossing::rate_of(Index contact, const Eigen::Vector2d& force, ConstVectorRef scale_v) const {
  const model::FreeObstacles::Ends& ends = obstacles_->ends_of(contact);
  double largest = 0.0;
  for (const auto& end : {ends.a, ends.b})
    for (std::size_t k = 0; k < 2; ++k)
      if (const Index dof = end[k]; dof >= 0 && scale_v[dof] > 0.0)
        largest = std::max(largest, force[static_cast<Index>(k)] / (mass_[dof] * scale_v[dof]));
  return largest;
}

double CentreCrossing::jump(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v) const {
  double largest = 0.0;
  for (const dynamics::CentrePull& pull : pulls_) {
    const auto begin = obstacles_->motion(pull.contact, from.x, from.v),
               end = obstacles_->motion(pull.contact, to.x, to.v);
    const Eigen::Vector2d first = (begin.d - pull.centre).normalized();
    Eigen::Vector2d last = begin.d;
    bool is_fast = false;
    Eigen::Vector2d turned = {0.0, 0.0};
    for (int k = 1; k <= kPieces; ++k) {
      const Eigen::Vector2d next = on_the_way(h, begin, end, static_cast<double>(k) / kPieces);
      is_fast = is_fast || distance_to_line(pull.centre, last, next) < kPieces * (next - last).norm();
      turned = turned.cwiseMax(((next - pull.centre).normalized() - first).cwiseAbs());
      last = next;
    }
    if (is_fast) largest = std::max(largest, rate_of(pull.contact, pull.force * turned, scale_v));
  }
  return largest;
}

}  // namespace butee::integrators
