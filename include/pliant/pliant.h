// Includes all public headers: those of the core library, and those for files.
#pragma once

#include "pliant/advise.h"
#include "pliant/constraint.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/motion.h"
#include "pliant/queries.h"
#include "pliant/reference.h"
#include "pliant/report.h"
#include "pliant/save.h"
#include "pliant/scene.h"
#include "pliant/state.h"
#include "pliant/vec3.h"
#include "pliant/world.h"
