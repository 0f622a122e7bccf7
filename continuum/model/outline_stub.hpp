#pragma once
#include "continuum/model/outline.hpp"
namespace drumlin::continuum {
Outline laid_down(const Outline& o, const Region& region, double time, const SizeField& size);
}
