#include "model/gather_constraints.h"

#include <map>
#include <string>
#include <utility>

#include "constraints/all.h"
#include "model/stiffness.h"
#include "pliant/error.h"

namespace pliant {

namespace {

Vec3<double> to_double(const Vec3f& v) { return {v.x, v.y, v.z}; }

template <class T>
constexpr int field_count = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));

/// The rest data of one constraint as the positions show it.
template <class T>
void measure(const Object& object, const int* stencil, std::vector<float>& rest) {
  Vec3<double> x[T::size];
  for (int slot = 0; slot < T::size; ++slot) x[slot] = to_double(object.positions[stencil[slot]]);
  const auto params = T::template measure<double>(x);
  double fields[field_count<T>];
  static_assert(sizeof fields == sizeof params);
  std::memcpy(fields, &params, sizeof fields);
  for (double field : fields) rest.push_back(static_cast<float>(field));
}

Law law_of(const Stiffness& stiffness) {
  if (stiffness.kind == Stiffness::Kind::pbd) return Law::pbd;
  return stiffness.damping > 0 ? Law::damped : Law::compliant;
}

class Gatherer {
 public:
  Gatherer(const Object& object, int passes) : object_(object), passes_(passes) {}

  void add(const ConstraintGroup& group) {
    bool known = false;
    for_each_type(AllConstraints{}, [&](auto tag, int type) {
      using T = typename decltype(tag)::type;
      if (group.type != T::name) return;
      known = true;
      add_group<T>(group, type);
    });
    if (!known)
      throw Error({.object = object_.name}, "unknown constraint type '" + group.type + "'", "use one of " + names());
  }

  void add_attachments() {
    for (std::size_t i = 0; i < object_.attachments.size(); ++i) {
      const Attachment& attachment = object_.attachments[i];
      ConstraintList& list = list_of<Distance>(0, law_of(attachment.stiffness));
      list.stencils.push_back(attachment.particle);
      list.stencils.push_back(static_cast<int>(object_.positions.size() + i));
      list.rest.push_back(0);
      push_response(list, attachment.stiffness, attachment.stiffness.value, 0);
    }
  }

  std::vector<ConstraintList> take() {
    std::vector<ConstraintList> lists;
    for (auto& [key, list] : lists_) {
      if (list.count() > 0) lists.push_back(std::move(list));  // a group may be empty
    }
    return lists;
  }

 private:
  static std::string names() {
    std::string text;
    for_each_type(AllConstraints{},
                  [&](auto tag, int) { text += (text.empty() ? "" : ", ") + std::string(decltype(tag)::type::name); });
    return text;
  }

  template <class T>
  ConstraintList& list_of(int type, Law law) {
    ConstraintList& list = lists_[{type, law}];
    list.type = type;
    list.law = law;
    list.size = T::size;
    list.fields = field_count<T>;
    return list;
  }

  void push_response(ConstraintList& list, const Stiffness& stiffness, float value, int type) {
    const bool pbd = stiffness.kind == Stiffness::Kind::pbd;
    list.response.push_back(pbd ? static_cast<float>(stiffness_per_projection(value, passes_)) : value);
    list.damping.push_back(stiffness.damping);
    list.origin.push_back(next_origin_[type]++);
  }

  template <class T>
  void require_sizes(const ConstraintGroup& group) const {
    const std::size_t count = group.particles.size() / T::size;
    const auto refuse = [&](const std::string& problem) {
      throw Error({.object = object_.name, .element = std::string(T::name) + " constraints"}, problem);
    };
    if (group.particles.size() % T::size != 0) {
      refuse(std::to_string(group.particles.size()) + " particles do not make stencils of " + std::to_string(T::size));
    }
    if (!group.rest.empty() && group.rest.size() != count * field_count<T>) {
      refuse(std::to_string(group.rest.size()) + " rest values where " + std::to_string(count * field_count<T>) +
             " are needed");
    }
    if (!group.compliances.empty() && group.compliances.size() != count) {
      refuse(std::to_string(group.compliances.size()) + " compliances for " + std::to_string(count) + " constraints");
    }
    for (int particle : group.particles) {
      if (particle < 0 || particle >= static_cast<int>(object_.positions.size())) {
        refuse("particle " + std::to_string(particle) + " does not exist");
      }
    }
  }

  template <class T>
  void add_group(const ConstraintGroup& group, int type) {
    require_sizes<T>(group);
    ConstraintList& list = list_of<T>(type, law_of(group.stiffness));
    const std::size_t count = group.particles.size() / T::size;
    list.stencils.insert(list.stencils.end(), group.particles.begin(), group.particles.end());
    list.rest.insert(list.rest.end(), group.rest.begin(), group.rest.end());
    list.response.reserve(list.response.size() + count);
    for (std::size_t i = 0; i < count; ++i) {
      if (group.rest.empty()) measure<T>(object_, &group.particles[i * T::size], list.rest);
      push_response(list, group.stiffness, group.compliances.empty() ? group.stiffness.value : group.compliances[i], type);
    }
  }

  const Object& object_;
  int passes_;
  std::map<std::pair<int, Law>, ConstraintList> lists_;
  std::map<int, int> next_origin_;
};

}  // namespace

std::vector<ConstraintList> gather_constraints(const Object& object, int passes) {
  Gatherer gatherer(object, passes);
  for (const ConstraintGroup& group : object.constraints) gatherer.add(group);
  gatherer.add_attachments();
  return gatherer.take();
}

}  // namespace pliant
