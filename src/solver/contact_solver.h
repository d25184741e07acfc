// Projects the contacts of a substep on all threads.
//
// Contacts have a total order. In that order each gets the first of 64 colours that none of its points has, so contacts of
// a colour share no dynamic point. Those without a free colour form the tail, which is projected serially at the end.
// Colours depend on the contacts alone, so threads and instruction set do not change any bits.
//
// Contacts of static neighbour pairs lead: all of them are projected before the others, which have the last word. If mixed,
// static neighbours would undo the corrections between stacked layers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "constraints/contact.h"
#include "parallel/executor.h"
#include "solver/contact_kernels.h"

namespace pliant {

/// Contacts by colour.
class ContactColours {
 public:
  /// Colours contacts [first, last), with point indices below `points`. Points of infinite mass may be shared.
  void colour(const std::vector<Contact>& contacts, std::size_t first, std::size_t last, const Record* positions,
              std::size_t points);
  /// Those of the same contacts for which `is_kept(index)` holds, in the same order.
  ContactColours only(FunctionRef<bool(std::int32_t)> is_kept) const;

  /// Contact indices by colour, ascending within each; the tail is last.
  const std::vector<std::int32_t>& order() const { return order_; }
  /// The start of each colour in order(), and the end of the last.
  const std::vector<std::int32_t>& start() const { return start_; }

 private:
  std::vector<std::uint64_t> taken_;  ///< colours of each point; all 0 between calls
  std::vector<std::uint8_t> colour_;  ///< colour of each contact
  std::vector<std::int32_t> order_, start_;
};

/// Projects contacts and applies restitution, colour by colour.
class ContactSolver {
 public:
  /// Replaces the contacts of the previous substep and colours the new ones. The first `leading` are projected first.
  void begin(const ContactKernels& kernels, const std::vector<Contact>& contacts, std::size_t leading,
             const Record* positions, std::size_t points);
  /// Of the same contacts, those for which `is_kept` holds, in the same order.
  ContactSolver only(const std::vector<Contact>& contacts, FunctionRef<bool(const Contact&)> is_kept) const;
  /// Projects each contact once.
  void project(Executor& executor, const char* name, std::vector<Contact>& contacts, Record* displacements) const;
  /// Calls answer(contact) once for each contact; concurrent calls share no dynamic point.
  void for_each(Executor& executor, const char* name, const std::vector<Contact>& contacts,
                FunctionRef<void(const Contact&)> answer) const;

 private:
  /// Calls body(first, last) for ranges of each colour, concurrently if it is large; then tail(first, last).
  void for_ranges(Executor& executor, const char* name, const ContactColours& colours, FunctionRef<void(int, int)> body,
                  FunctionRef<void(int, int)> tail) const;

  const ContactKernels* kernels_ = nullptr;
  std::array<ContactColours, 2> sections_;  ///< the leading contacts, and the others
};

}  // namespace pliant
