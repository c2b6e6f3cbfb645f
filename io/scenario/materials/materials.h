#pragma once
#include "io/scenario/materials/bare.h"
#include "io/scenario/materials/elastic.h"
#include "io/scenario/materials/fluid.h"
#include "io/scenario/materials/grain_size.h"
#include "io/scenario/materials/layered.h"
#include "io/scenario/materials/reflection.h"

namespace asdic::detail::scenario {

/// Every way to say what is behind a boundary. A new one is its file and one name here
/// (docs/develop/recipes.md).
using AnyMaterialForm = OneOfForms<BareForm<Vacuum>, BareForm<Rigid>, FluidForm, ElasticForm,
                                   GrainSizeForm, ReflectionForm, LayeredForm>;

}  // namespace asdic::detail::scenario
