#include "collision/near/clearance_search.h"

#include <algorithm>

#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int questions_in_a_task = 16;
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
  const int count = static_cast<int>(questions_.size());
  const auto tasks = static_cast<std::size_t>(ranges_of(count, questions_in_a_task));
  if (scratch_.size() < tasks) scratch_.resize(tasks);
  for_ranges(executor, "look for clearance", count, questions_in_a_task, [&](int first, int last) {
    auto& scratch = scratch_[static_cast<std::size_t>(first / questions_in_a_task)];
    for (int i = first; i < last; ++i) {
      const Question& question = questions_[static_cast<std::size_t>(i)];
      answers_[static_cast<std::size_t>(question.pair)] =
          clearance_.between(kernels, question.first, question.second, question.wanted, scratch);
    }
  });
}

}  // namespace pliant
