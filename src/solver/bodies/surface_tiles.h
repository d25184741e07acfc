// The surfaces that bodies can touch, tile by tile: their triangles, and which solids are near. Lists of near solids
// are kept while tiles and solids stay in boxes that are a little larger than their own, so the cost of a substep is
// linear in both.
#pragma once

#include <array>
#include <vector>

#include "collision/broad/tree.h"
#include "collision/narrow/contact.h"
#include "collision/narrow/near_points.h"
#include "model/model.h"

namespace pliant {

struct Substep;

/// The triangles whose lowest vertex is in a tile, or, without triangles, the lines (a, b, b). Indices in the State.
struct SurfaceTile {
  int task = 0, object = 0;
  int first = 0, last = 0;                   ///< particles of the tile
  std::vector<std::array<int, 3>> elements;  ///< by their lowest vertex
  std::vector<int> first_element;            ///< [particle of the tile] the last entry is the number of elements
  std::vector<int> border;                   ///< vertices of elements in other tiles, ascending
  bool has_triangles = false;
  float named_thickness = 0;   ///< the largest that the scene's `pairs` name with its object [m]
  BoxBounds box{};             ///< of its elements in the substep, as predicted
  float fastest = 0;           ///< largest predicted displacement of their vertices [m]
  float longest = 0;           ///< upper bound of the edges' lengths at the substep's start [m]
  float grown = 0;             ///< what of it comes from motion since it was measured [m]
  std::vector<Record> before;  ///< positions of its particles and border at the last substep's start
  NearPoints near_points;
  std::vector<int> solids;  ///< that may be near, ascending
};

class SurfaceTiles {
 public:
  SurfaceTiles() = default;
  SurfaceTiles(const Model& model, const std::vector<int>& tasks);

  /// Forgets lengths of edges, which may have changed between frames.
  void begin_frame();

  /// Finds near solids for the present displacements. Call it where the substep `begins` first.
  void update(const Substep& s, const std::vector<MovingCollider>& solids, bool begins);

  /// In the order of tasks.
  const std::vector<SurfaceTile>& tiles() const { return tiles_; }
  /// The lists of one of them, which may be made for one tile at a time on each thread.
  NearPoints& near_points(int tile) { return tiles_[static_cast<std::size_t>(tile)].near_points; }
  /// Sorts the particles of a tile into cells, and measures its edges. Call it before cells are read in a substep.
  void sort_points(const Substep& s, int tile);
  /// Indices of the tiles that may be near a solid, ascending.
  const std::vector<int>& tiles_near(int solid) const { return tiles_near_[static_cast<std::size_t>(solid)]; }

 private:
  bool are_lists_valid(const std::vector<MovingCollider>& solids) const;
  void make_lists(const std::vector<MovingCollider>& solids);

  std::vector<SurfaceTile> tiles_;
  std::vector<std::vector<int>> tiles_near_;
  std::vector<BoxBounds> kept_tiles_, kept_solids_;  ///< boxes for which the lists are valid
  Tree<BoxBounds> tree_;
};

}  // namespace pliant
