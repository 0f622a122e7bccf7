#pragma once
// The contact problems of discs.
#include "particles/contact/contact_problem.hpp"
#include "particles/contact/disc_delassus.hpp"
#include "particles/contact/problem_kinds.hpp"
