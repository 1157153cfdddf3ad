// Kernels are listed once for each room that uses them, by a macro
//
//   #define WEFT_…_KERNELS(KERNEL) KERNEL(returns, name, (arguments)) …
//
// from which come the room's table, whose members have the names of the kernels, the declarations of the kernels
// of every instruction set, and the tables of these (table.cpp). So no member can hold another kernel than its own.
#pragma once

#define WEFT_KERNEL_MEMBER(returns, name, arguments) returns(*name) arguments;
