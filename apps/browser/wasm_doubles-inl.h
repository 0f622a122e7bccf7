// Vectors of two doubles for WebAssembly, which Highway 1.0 has not. Included before a kernel's text.
#pragma once
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which has one instruction set here.
#include <hwy/highway.h>
#include <wasm_simd128.h>

#include <cstddef>

namespace hwy::HWY_NAMESPACE {

using Doubles = Vec128<double, 2>;
using MaskOfDoubles = Mask128<double, 2>;

HWY_API Doubles Set(Simd<double, 2, 0>, double number) { return {wasm_f64x2_splat(number)}; }

HWY_API Doubles operator+(Doubles a, Doubles b) { return {wasm_f64x2_add(a.raw, b.raw)}; }
HWY_API Doubles operator-(Doubles a, Doubles b) { return {wasm_f64x2_sub(a.raw, b.raw)}; }
HWY_API Doubles operator*(Doubles a, Doubles b) { return {wasm_f64x2_mul(a.raw, b.raw)}; }
HWY_API Doubles operator/(Doubles a, Doubles b) { return {wasm_f64x2_div(a.raw, b.raw)}; }
HWY_API Doubles Sqrt(Doubles a) { return {wasm_f64x2_sqrt(a.raw)}; }
HWY_API Doubles Abs(Doubles a) { return {wasm_f64x2_abs(a.raw)}; }
HWY_API Doubles Floor(Doubles a) { return {wasm_f64x2_floor(a.raw)}; }

// The second one where either is NaN.
HWY_API Doubles Min(Doubles a, Doubles b) { return {wasm_f64x2_pmin(b.raw, a.raw)}; }
HWY_API Doubles Max(Doubles a, Doubles b) { return {wasm_f64x2_pmax(b.raw, a.raw)}; }

HWY_API MaskOfDoubles Gt(Doubles a, Doubles b) { return {wasm_f64x2_gt(a.raw, b.raw)}; }
HWY_API MaskOfDoubles Ge(Doubles a, Doubles b) { return {wasm_f64x2_ge(a.raw, b.raw)}; }
HWY_API MaskOfDoubles Le(Doubles a, Doubles b) { return {wasm_f64x2_le(a.raw, b.raw)}; }

}  // namespace hwy::HWY_NAMESPACE
