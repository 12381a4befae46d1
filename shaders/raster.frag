#version 460
// SPDX-License-Identifier: MIT
//
// Which triangle a pixel sees.
layout(location = 0) flat in uint triangle;
layout(location = 0) out uint seen;

void main()
{
    seen = triangle;
}
