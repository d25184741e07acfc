// Solves chains again where surfaces press on one another or on rigid bodies.
//
// Contacts are projected after the chains, so where they conflict contacts win, and edges end too long: in jammed or
// pinched cloth one in a hundred by 3 %, however many iterations follow, because both cannot be met exactly. So chains
// and contacts take turns once more, and contacts yield: they may overlap by a share of their thickness, which nobody
// sees, while an edge that is too long is seen. The filter still keeps surfaces from crossing. What is far heavier than the
// cloth that it lies on, such as stones, would be overrun by it in this way, so its contacts do not yield.
#include "solver/stages/solve_again.h"
#include "solver/bodies/body_solver.h"

#include "solver/drivers/contacts.h"
#include "solver/drivers/driver.h"
#include "solver/momentum.h"
#include "solver/object_lookup.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Marks the objects solved by chains whose surface an active contact touches. False if there are none.
bool find_pressed(const Substep& s, std::vector<char>& is_pressed) {
  is_pressed.assign(s.model.objects.size(), 0);
  bool any = false;
  ObjectLookup objects(s.model);
  const auto mark = [&](const std::vector<Contact>& contacts) {
    for (const Contact& contact : contacts) {
      if (!(contact.push > 0)) continue;
      for (std::size_t i = 0; i < contact.point.size(); ++i) {
        if (contact.weight[i] == 0) continue;
        const int object = objects.of(contact.point[i]);
        if (!solves_chains(s.model.objects[object].sweep)) continue;
        is_pressed[object] = 1;
        any = true;
      }
    }
  };
  if (s.has_pairs()) mark(s.pairs->contacts());
  if (s.bodies != nullptr) mark(s.bodies->point_contacts());
  return any;
}

void solve_chains(Substep& s, const std::vector<char>& of) {
  for (const auto& [sweep, group] : s.work.sweeps) {
    if (!solves_chains(sweep)) continue;
    s.group = &group;
    walk(s, Driver::chain, {false, Order::forward, 0, &of});
  }
  s.group = nullptr;
}

}  // namespace

void solve_again(Substep& s) {
  if ((!s.has_pairs() && s.bodies == nullptr) || s.lengths().empty() || !(s.context.options.most_overstretch > 0)) return;
  std::vector<char>& is_pressed = s.own->limit.is_moved;
  if (!find_pressed(s, is_pressed)) return;
  constexpr int rounds = 2;  // of chains and contacts
  for (int round = 0; round < rounds; ++round) {
    note_momentum(s, Since::note, &is_pressed);
    if (s.bodies != nullptr) s.bodies->find_loads(s);
    solve_chains(s, is_pressed);
    conserve_momentum(s, Since::note, &is_pressed);
    project_contacts_of(s, "solve: contacts among surfaces", is_pressed, overlap_left);
  }
}

}  // namespace pliant
