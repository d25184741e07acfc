#include "model/cluster_moments.h"

#include "math/scalar.h"

namespace pliant {

namespace {

double determinant3(const std::vector<double>& a, std::size_t n) {
  const auto at = [&](std::size_t i, std::size_t j) { return a[i * n + j]; };
  return at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
         at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
         at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
}

/// a^T moments b.
double product(const std::vector<double>& moments, const double* a, const double* b, std::size_t size) {
  double sum = 0;
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) sum += a[i] * moments[i * size + j] * b[j];
  return sum;
}

/// Makes row k orthogonal to those before it.
void take_out(const std::vector<double>& moments, std::vector<double>& basis, std::size_t size, std::size_t k) {
  double* row = basis.data() + k * size;
  for (std::size_t i = 0; i < k; ++i) {
    const double* before = basis.data() + i * size;
    const double along = product(moments, before, row, size);
    for (std::size_t j = 0; j <= i; ++j) row[j] -= along * before[j];
  }
}

}  // namespace

bool is_flat(const std::vector<double>& moments, int n) {
  const auto size = static_cast<std::size_t>(n);
  const double mean = (moments[0] + moments[size + 1] + moments[2 * size + 2]) / 3;
  constexpr double thinnest = 1e-6;  // square of a thousandth, of one direction
  return !(determinant3(moments, size) > thinnest * mean * mean * mean);
}

std::vector<double> inverse_of_moments(std::vector<double> a, int n) {
  const auto size = static_cast<std::size_t>(n);
  double trace = 0;
  for (std::size_t i = 0; i < size; ++i) trace += a[i * size + i];
  constexpr double share = 1e-10;
  const double added = trace > 0 ? share * trace / n : 1;
  for (std::size_t i = 0; i < size; ++i) a[i * size + i] += added;

  // Gauss and Jordan without pivoting, as the matrix is positive definite.
  std::vector<double> inverse(size * size, 0);
  for (std::size_t i = 0; i < size; ++i) inverse[i * size + i] = 1;
  for (std::size_t p = 0; p < size; ++p) {
    const double scale = 1 / a[p * size + p];
    for (std::size_t j = 0; j < size; ++j) {
      a[p * size + j] *= scale;
      inverse[p * size + j] *= scale;
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (i == p) continue;
      const double factor = a[i * size + p];
      for (std::size_t j = 0; j < size; ++j) {
        a[i * size + j] -= factor * a[p * size + j];
        inverse[i * size + j] -= factor * inverse[p * size + j];
      }
    }
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      inverse[i * size + j] = inverse[j * size + i] = (inverse[i * size + j] + inverse[j * size + i]) / 2;
  return inverse;
}

std::vector<double> orthonormal_basis(const std::vector<double>& moments, int n) {
  const auto size = static_cast<std::size_t>(n);
  double least[2] = {};  // of the coordinates and of their products: 1e-10 of the mean
  constexpr double share = 1e-10;
  for (std::size_t i = 0; i < size; ++i) least[i / 3 > 0] += share * moments[i * size + i] / (i < 3 ? 3 : 6);
  std::vector<double> basis(size * size, 0);
  for (std::size_t k = 0; k < size; ++k) {
    double* row = basis.data() + k * size;
    row[k] = 1;
    // Twice, because one pass of Gram and Schmidt leaves rounding that grows with what is taken out.
    for (int pass = 0; pass < 2; ++pass) take_out(moments, basis, size, k);
    const double square = product(moments, row, row, size);
    const double scale = square > least[k / 3 > 0] ? 1 / sqrt(square) : 0;
    for (std::size_t j = 0; j <= k; ++j) row[j] *= scale;
  }
  return basis;
}

}  // namespace pliant
