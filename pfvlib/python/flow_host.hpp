// SPDX-License-Identifier: GPL-3.0-or-later
// A flow as Python holds it: who may work on it, and who keeps the forces.
#pragma once

#include "grains.hpp"
#include "pfv/darcy_grid.hpp"
#include "pfv/flow.hpp"
#include "pfv/settings.hpp"

#include <memory>
#include <string>
#include <vector>

namespace pfv::python {

/// The forces of a step for the arrays that look at them. They stay the library's own until the next step asks
/// for their place, which then gets another one: no number is copied, and no array changes or dies.
class LentForces {
 public:
  explicit LentForces(std::shared_ptr<FlowModel> model) : model_(std::move(model)), forces_(&model_->forces()) {}
  const Forces& get() const { return *forces_; }
  void take_over();

 private:
  std::shared_ptr<FlowModel> model_;
  const Forces* forces_;
  Forces taken_;
};

class FlowHost {
 public:
  FlowHost(const Container& container, const Settings& settings);

  /// A step: forces after it. Throws as FlowModel::advance.
  void advance(const Grains& grains, double dt, const Step& step);

  /// Work on the model without the interpreter's lock: no objects of Python in it. Throws InputError while
  /// another thread works on this flow.
  template <class Work>
  auto run(const Work& work) {
    const Turn turn(busy_);
    const py::gil_scoped_release released;
    return work(*model_);
  }
  /// The same on the results of the last step. Throws InputError where there are none.
  template <class Work>
  auto ask(const Work& work) {
    require_result();
    return run(work);
  }
  /// Of one of the two models. Throws InputError for the other.
  template <class Model, class Work>
  auto ask_of(const Work& work) {
    return ask([&work](FlowModel& model) {
      auto* one = dynamic_cast<Model*>(&model);
      if (!one) throw InputError("the model " + other_model<Model>() + " has no such result: see Flow's keyword model");
      return work(*one);
    });
  }

  /// Forces of the last step and what keeps them, for arrays.
  std::shared_ptr<LentForces> forces();
  const Settings& settings() const { return settings_; }
  Container container();

 private:
  /// One thread at a time; counted under the interpreter's lock.
  class Turn {
   public:
    explicit Turn(bool& busy);
    ~Turn() { busy_ = false; }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    bool& busy_;
  };

  template <class Model>
  static std::string other_model() {
    return name_of(std::is_same_v<Model, Flow> ? pfv::Model::darcy_grid : pfv::Model::pores);
  }
  void require_result() const;

  Settings settings_;
  std::shared_ptr<FlowModel> model_;
  std::shared_ptr<LentForces> lent_;
  bool busy_ = false, has_result_ = false;
};

}  // namespace pfv::python
