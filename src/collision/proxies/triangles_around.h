// Which triangles stand at a vertex: for tangles, whose neighbourhood is asked for.
#pragma once

#include "collision/proxies/contact_elements.h"

namespace pliant {

/// For each vertex the triangles at it, ascending.
IntLists triangles_around(const ContactElements& elements);

}  // namespace pliant
