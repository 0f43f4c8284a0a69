// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/obstacle_places.hpp"

#include "network/closest_point.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;

// as parts of the diameter
constexpr double thinnest = 0.6;      // a sheet
constexpr double places_apart = 0.25;
constexpr double balls_apart = 0.5;   // of closed parts
constexpr double thin_places = 0.12;  // places and balls of sheets and thin walls
constexpr double deviation = 0.1;  // of the surface from the balls
constexpr double rounded = 0.05;   // more than that of edges and corners, which no ball reaches
constexpr double distinct = 0.02;  // centres are at least so far apart
/// Of its radius: so far a ball stands for the middle of a thin wall or a sheet. No hole is left between three of them,
/// since the circle through their centres stays below the radius, also with what lies between the places (0.21 of the
/// radius more).
constexpr double tight = 0.72;
constexpr double facing = -0.9;  // cosine between the normals of two sides of a thin wall
/// What differs by less is alike, and the first of those is taken: symmetric meshes are full of ties, which another
/// origin or unit would round in another way.
constexpr double alike = 1e-7;

/// Halves the longest edge until none is longer than `step`.
void divide(const Triangle& triangle, double step, std::vector<Triangle>& pieces) {
  int longest = 0;
  double length = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double own = (triangle.col((k + 1) % 3) - triangle.col(k)).norm();
    if (own > length * (1.0 + alike)) {
      longest = k;
      length = own;
    }
  }
  if (length <= step * (1.0 + alike)) {
    pieces.push_back(triangle);
    return;
  }
  const Vector middle = 0.5 * (triangle.col(longest) + triangle.col((longest + 1) % 3));
  for (const int k : {longest, (longest + 1) % 3}) {
    Triangle half = triangle;
    half.col(k) = middle;
    divide(half, step, pieces);
  }
}

std::vector<Triangle> pieces_of(const Triangle& triangle, double step) {
  std::vector<Triangle> pieces;
  divide(triangle, step, pieces);
  return pieces;
}

struct Touching {
  double radius;
  bool thin;  ///< it touches two sides of a wall
};

/// Of the ball that touches the surface at `place` and passes through another place of it.
double radius_through(const Vector& other, const Vector& place, const Vector& outward) {
  const Vector way = other - place;
  const double depth = -outward.dot(way);
  return depth > 1e-9 * way.norm() ? way.squaredNorm() / (2.0 * depth) : std::numeric_limits<double>::max();
}

/// The largest ball that touches the surface at `place` from within: Ma, Bae & Choi (2012), which shrinks a ball to the
/// nearest place of the surface until none is in it. It begins with one that holds none of the `corners`.
Touching largest_ball(const Vector& place, const Vector& outward, const Eigen::Matrix3Xd& corners,
                      const ClosestPoint& surface, const std::vector<Triangle>& triangles) {
  constexpr double round_off = 1e-9;
  Touching found{std::numeric_limits<double>::max(), false};
  for (Eigen::Index k = 0; k < corners.cols(); ++k)
    found.radius = std::min(found.radius, radius_through(corners.col(k), place, outward));
  for (int turn = 0; turn < 100; ++turn) {
    const Vector centre = place - found.radius * outward;
    const Vector nearest = surface.to(centre).place;
    const double radius = radius_through(nearest, place, outward);
    if (!((nearest - centre).norm() < found.radius * (1.0 - round_off)) || !(radius < found.radius)) break;
    found.radius = radius;
  }
  // a little further in, what it touches elsewhere is the nearest
  const int other = surface.to(place - 1.001 * found.radius * outward).triangle;
  found.thin = area_vector(triangles[other]).normalized().dot(outward) < facing;
  return found;
}

/// Not too many of them: a first guess only.
Eigen::Matrix3Xd some_corners(const MeshPart& part) {
  constexpr std::size_t most = 1000;
  const std::size_t stride = part.triangles.size() / most + 1;
  Eigen::Matrix3Xd corners(3, 0);
  for (std::size_t t = 0; t < part.triangles.size(); t += stride) {
    corners.conservativeResize(3, corners.cols() + 3);
    corners.rightCols(3) = part.triangles[t];
  }
  return corners;
}

ObstacleBall ball_of(const Vector& centre, double inscribed, double radius, double diameter) {
  // a thin wall is tight where its middle is, a thick body stays within the deviation
  const double reach = std::min(radius + deviation * diameter, std::hypot(inscribed, tight * radius));
  return {centre, inscribed, radius, reach};
}

Vector add_place(const Triangle& piece, ObstaclePlaces& all) {
  all.places.push_back({piece.rowwise().mean(), area_vector(piece).norm()});
  return all.places.back().place;
}

void add_sheet(const MeshPart& part, double diameter, ObstaclePlaces& all) {
  for (const Triangle& triangle : part.triangles)
    for (const Triangle& piece : pieces_of(triangle, thin_places * diameter))
      all.balls.push_back(ball_of(add_place(piece, all), 0.0, 0.5 * thinnest * diameter, diameter));
}

void add_solid(const MeshPart& part, double diameter, ObstaclePlaces& all) {
  const ClosestPoint surface(part.triangles);
  const Eigen::Matrix3Xd corners = some_corners(part);
  const double thin = 0.5 * thinnest * diameter;
  for (const Triangle& triangle : part.triangles) {
    const Vector outward = area_vector(triangle).normalized();
    const auto ball_at = [&](const Vector& place) { return largest_ball(place, outward, corners, surface, part.triangles); };
    for (const Triangle& piece : pieces_of(triangle, balls_apart * diameter)) {
      const Vector middle = piece.rowwise().mean();
      const Touching found = ball_at(middle);
      const bool narrow = found.radius < (0.5 - alike) * diameter;
      if (found.thin && narrow) {
        for (const Triangle& small : pieces_of(piece, thin_places * diameter)) {
          const Vector place = add_place(small, all);
          const Touching own = ball_at(place);
          if (own.thin) all.balls.push_back(ball_of(place - own.radius * outward, own.radius, std::max(own.radius, thin), diameter));
        }
        continue;
      }
      for (const Triangle& small : pieces_of(piece, places_apart * diameter)) add_place(small, all);
      if (narrow) continue;  // at an edge, which stays rounded
      all.balls.push_back(ball_of(middle - found.radius * outward, found.radius, found.radius, diameter));
    }
  }
}

/// Along the edges of a part. Balls stand within a sheet, also where it ends at a wall.
void add_edges(const MeshPart& part, double diameter, ObstaclePlaces& all) {
  const double step = places_apart * diameter;
  for (const auto& [begin, end] : part.edges) {
    const int steps = std::max(1, static_cast<int>(std::ceil((end - begin).norm() / step - alike)));
    for (int i = 0; i <= steps; ++i) all.places.push_back({begin + (end - begin) * i / steps, 0.25 * step * step});
  }
}

/// The places that no ball reaches yet.
class Uncovered {
 public:
  Uncovered(const std::vector<ObstaclePlace>& places, double margin) : left_(places), margin_(margin) {
    for (ObstaclePlace& one : left_) one.beyond = std::numeric_limits<double>::max();
  }
  bool empty() const { return left_.empty(); }
  void take(const ObstacleBall& ball) {
    std::size_t kept = 0;
    for (ObstaclePlace& one : left_) {
      one.beyond = std::min(one.beyond, (one.place - ball.centre).norm() - ball.reach);
      if (one.beyond > margin_) left_[kept++] = one;
    }
    left_.resize(kept);
  }
  /// The one next to what is reached: so the front advances without leaving slivers behind.
  std::size_t front() const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < left_.size(); ++i)
      if (left_[i].beyond < left_[nearest].beyond - margin_) nearest = i;
    return nearest;
  }
  const ObstaclePlace& operator[](std::size_t i) const { return left_[i]; }
  void give_up(std::size_t i) { left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i)); }
  /// Those around a place.
  std::vector<ObstaclePlace> near(const Vector& place, double distance) const {
    std::vector<ObstaclePlace> result;
    for (const ObstaclePlace& one : left_)
      if ((one.place - place).norm() < distance + margin_) result.push_back(one);
    return result;
  }

 private:
  std::vector<ObstaclePlace> left_;
  double margin_;
};

double gain(const ObstacleBall& ball, const std::vector<ObstaclePlace>& places, double margin) {
  double area = 0.0;
  for (const ObstaclePlace& one : places)
    if ((one.place - ball.centre).norm() <= ball.reach + margin) area += one.area;
  return area;
}

/// Of the balls that reach the place (a few of many) the one that reaches most of what none has reached yet around it.
/// Where no ball does: of those that come nearest, to a margin; -1 if one that was chosen is as near.
int best_ball(const ObstaclePlace& front, double diameter, const std::vector<ObstacleBall>& balls,
              const Uncovered& uncovered) {
  constexpr std::size_t looked_at = 32;
  Eigen::ArrayXd from(static_cast<Eigen::Index>(balls.size()));
  for (Eigen::Index j = 0; j < from.size(); ++j) from[j] = (front.place - balls[j].centre).norm() - balls[j].reach;
  const double margin = alike * diameter, nearest = from.minCoeff();
  const double taken = margin + (nearest > margin ? nearest + rounded * diameter : 0.0);
  if (front.beyond <= taken) return -1;
  std::vector<int> reaching;
  for (int j = 0; j < static_cast<int>(balls.size()); ++j)
    if (from[j] <= taken) reaching.push_back(j);
  const std::vector<ObstaclePlace> around = uncovered.near(front.place, 3.0 * diameter);
  int best = -1;
  double most = -1.0;
  const std::size_t stride = reaching.size() / looked_at + 1;
  for (std::size_t i = 0; i < reaching.size(); i += stride) {
    const double own = gain(balls[reaching[i]], around, margin);
    if (!(own > most * (1.0 + alike))) continue;
    most = own;
    best = reaching[i];
  }
  return best;
}

/// Opposite sides of a wall have one middle, and a round body one centre: once is enough.
void take_with_neighbours(int ball, const std::vector<ObstacleBall>& balls, double apart, std::vector<char>& taken) {
  for (std::size_t j = 0; j < balls.size(); ++j)
    if ((balls[j].centre - balls[ball].centre).norm() < apart) taken[j] = 1;
}

}  // namespace

ObstaclePlaces places_of(const MeshPart& part, double diameter) {
  ObstaclePlaces all;
  if (part.closed) add_solid(part, diameter, all);
  else add_sheet(part, diameter, all);
  add_edges(part, diameter, all);
  return all;
}

std::vector<ObstacleBall> chosen_balls(const ObstaclePlaces& all, double diameter, std::size_t most) {
  std::vector<ObstacleBall> chosen;
  if (all.balls.empty()) return chosen;
  const double margin = alike * diameter;
  Uncovered uncovered(all.places, margin);
  std::vector<char> taken(all.balls.size(), 0);
  const auto choose = [&](int ball) {
    take_with_neighbours(ball, all.balls, distinct * diameter + margin, taken);
    chosen.push_back(all.balls[ball]);
    uncovered.take(all.balls[ball]);
  };
  int largest = 0;
  for (int j = 1; j < static_cast<int>(all.balls.size()); ++j)
    if (all.balls[j].reach > all.balls[largest].reach + margin) largest = j;
  choose(largest);
  while (!uncovered.empty() && chosen.size() < most) {
    const std::size_t front = uncovered.front();
    const int next = best_ball(uncovered[front], diameter, all.balls, uncovered);
    if (next < 0 || taken[next]) uncovered.give_up(front);  // as near as can be
    else choose(next);
  }
  return chosen;
}

}  // namespace pfv
