// Projects the contacts of a substep on all threads.
//
// Contacts have a total order. In that order each gets the first of 64 colours that none of its points has, so contacts
// of a colour share no dynamic point. Those without a free colour form the tail, which is projected serially at the
// end. Colours depend on the contacts alone, so threads and instruction set do not change any bits.
//
// Contacts of static neighbour pairs are projected before all others, because the last projection prevails: in a mixed
// order, static neighbours would undo the corrections between stacked layers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "constraints/contact.h"
#include "parallel/executor.h"
#include "solver/contact_kernels.h"

namespace pliant {

/// Contacts sorted by colour.
class ContactColours {
 public:
  /// Colours contacts [first, last). Their point indices are below `points`. Points of infinite mass may occur
  /// repeatedly.
  void colour(const std::vector<Contact>& contacts, std::size_t first, std::size_t last, const Record* positions,
              std::size_t points);
  /// A copy with only the contacts for which `is_kept(index)` is true, in the same order.
  ContactColours only(FunctionRef<bool(std::int32_t)> is_kept) const;

  /// Contact indices by colour, ascending within each colour; the tail is last.
  const std::vector<std::int32_t>& order() const { return order_; }
  /// The start of each colour in order(), followed by the end of the last one.
  const std::vector<std::int32_t>& start() const { return start_; }

 private:
  /// Bit mask of the colours taken at each point; all 0 between calls.
  std::vector<std::uint64_t> taken_;
  std::vector<std::uint8_t> colour_;  ///< colour of each contact
  std::vector<std::int32_t> order_, start_;
};

/// Projects contacts and applies restitution in the order of colours.
class ContactSolver {
 public:
  /// Sets the contacts of a new substep and colours them. The first `leading` contacts are projected before the others.
  void begin(const ContactKernels& kernels, const std::vector<Contact>& contacts, std::size_t leading,
             const Record* positions, std::size_t points);
  /// A copy with only the contacts for which `is_kept` is true, in the same order.
  ContactSolver only(const std::vector<Contact>& contacts, FunctionRef<bool(const Contact&)> is_kept) const;
  /// Projects each contact once, as far as it overlaps by more than a share `yield` of its thickness.
  void project(Executor& executor, const char* name, std::vector<Contact>& contacts, Record* displacements,
               float yield = 0) const;
  /// Calls answer(contact) once for each contact. Contacts visited at the same time share no dynamic point.
  void for_each(Executor& executor, const char* name, const std::vector<Contact>& contacts,
                FunctionRef<void(const Contact&)> answer) const;

 private:
  /// Calls body(first, last) for ranges of each colour, on all threads if the colour is large; then tail(first, last).
  void for_ranges(Executor& executor, const char* name, const ContactColours& colours, FunctionRef<void(int, int)> body,
                  FunctionRef<void(int, int)> tail) const;

  const ContactKernels* kernels_ = nullptr;
  std::array<ContactColours, 2> sections_;  ///< [0]: leading contacts; [1]: the others
};

}  // namespace pliant
