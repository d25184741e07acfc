#include "collision/near/clearance_search.h"

#include <algorithm>

namespace pliant {

namespace {

constexpr std::size_t questions_in_a_task = 16;
constexpr float not_asked = -1;

}  // namespace

void ClearanceSearch::begin(std::size_t pairs) {
  questions_.clear();
  answers_.assign(pairs, not_asked);
}

void ClearanceSearch::ask(const ClusterSides& sides, float wanted) {
  float& answer = answers_[static_cast<std::size_t>(sides.pair)];
  if (answer != not_asked) return;
  answer = 0;
  questions_.push_back({sides.pair, sides.first, sides.second, wanted});
}

void ClearanceSearch::answer(Executor& executor, const PairKernels& kernels, const Record* positions) {
  std::fill(is_placed_.begin(), is_placed_.end(), 0);
  for (const Question& question : questions_) is_placed_[question.first] = is_placed_[question.second] = 1;
  executor.parallel_for("place corners", static_cast<int>(is_placed_.size()), [&](int c) {
    if (is_placed_[c] != 0) clearance_.place(kernels, c, positions);
  });
  const std::size_t tasks = (questions_.size() + questions_in_a_task - 1) / questions_in_a_task;
  if (scratch_.size() < tasks) scratch_.resize(tasks);
  executor.parallel_for("look for clearance", static_cast<int>(tasks), [&](int number) {
    const auto task = static_cast<std::size_t>(number);
    const std::size_t first = task * questions_in_a_task;
    for (std::size_t i = first; i < std::min(questions_.size(), first + questions_in_a_task); ++i) {
      const Question& question = questions_[i];
      answers_[static_cast<std::size_t>(question.pair)] =
          clearance_.between(kernels, question.first, question.second, question.wanted, scratch_[task]);
    }
  });
}

}  // namespace pliant
