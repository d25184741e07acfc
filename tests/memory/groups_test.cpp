// Tests that the memory of a World grows with its objects, although each object that follows its State is a substep
// group of its own. Bytes are counted where they are allocated, so no measurement of the machine matters.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>

#include "pliant/mesh.h"
#include "pliant/world.h"

namespace {

std::atomic<std::ptrdiff_t> bytes_in_use{0};

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  bytes_in_use += static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  return memory;
}

void release(void* memory) {
  bytes_in_use -= static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::free(memory);
}

void* aligned(std::size_t size, std::align_val_t alignment) {
  const auto to = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(to, (size + to - 1) / to * to));
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size > 0 ? size : 1)); }
void* operator new[](std::size_t size) { return counted(std::malloc(size > 0 ? size : 1)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted(std::malloc(size > 0 ? size : 1));
}
void* operator new(std::size_t size, std::align_val_t alignment) { return aligned(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return aligned(size, alignment); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace pliant {
namespace {

constexpr int rows = 20;

/// A self-colliding sheet that no other can touch. It has enough particles to follow its State.
Object sheet(int number) {
  TriangleMesh mesh = grid_mesh(rows, rows, 0.4f, 0.4f);
  for (Vec3f& p : mesh.positions) p.x += static_cast<float>(number);
  Object object = make_cloth(mesh);
  object.name = std::to_string(number);
  object.self_collision = true;
  object.thickness = 0.004f;
  return object;
}

/// The bytes that a World of so many sheets needs after its first step.
std::ptrdiff_t bytes_of(int sheets) {
  Scene scene;
  scene.settings.threads = 1;
  for (int i = 0; i < sheets; ++i) scene.add(sheet(i));
  const std::ptrdiff_t before = bytes_in_use;
  World world(scene);
  EXPECT_TRUE(world.step(1.f / 60).ok());
  EXPECT_EQ(world.object(0).info().substeps, 0);  // it follows its State
  return bytes_in_use - before;
}

TEST(GroupMemory, OfEachFurtherGroupIsThatOfTheFirstOnes) {
  (void)bytes_of(1);  // what is allocated once for all
  const std::ptrdiff_t few = bytes_of(20), more = bytes_of(40), many = bytes_of(160);
  const double of_twenty = static_cast<double>(more - few), of_a_hundred_and_twenty = static_cast<double>(many - more);
  EXPECT_LT(of_a_hundred_and_twenty, 1.1 * 6 * of_twenty) << few << " " << more << " " << many;
}

}  // namespace
}  // namespace pliant
