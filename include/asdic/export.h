#pragma once

/// What libasdic.so shows to those who link it. Everything else in it is hidden.
#define ASDIC_API __attribute__((visibility("default")))
