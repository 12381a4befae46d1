// SPDX-License-Identifier: MIT
// scan.glsl - what the threads of a work group find out together: the greatest of their numbers, and for each the sum of
// those before it. By shared memory alone. Needs common.glsl.

const uint SCAN_BLOCK = 16u;
shared uint scan_numbers[gl_WorkGroupSize.x];
shared uint scan_blocks[(gl_WorkGroupSize.x + SCAN_BLOCK - 1u) / SCAN_BLOCK];

uint group_size()
{
    return gl_WorkGroupSize.x;
}

// Numbers of the group's threads, one of each, block by block: some threads add up a block each, and then all look at the
// blocks.
uint scan_block_count()
{
    return (group_size() + SCAN_BLOCK - 1u) / SCAN_BLOCK;
}

// The greatest of all, by bits, which for floats that are not negative is the same.
uint greatest_in_group(uint number)
{
    const uint thread = gl_LocalInvocationID.x;
    barrier(); // what is in the numbers has been read
    scan_numbers[thread] = number;
    barrier();
    if (thread < scan_block_count()) {
        uint greatest = 0u;
        for (uint i = thread * SCAN_BLOCK; i < min((thread + 1u) * SCAN_BLOCK, group_size()); i++)
            greatest = max(greatest, scan_numbers[i]);
        scan_blocks[thread] = greatest;
    }
    barrier();
    uint greatest = 0u;
    for (uint i = 0u; i < scan_block_count(); i++)
        greatest = max(greatest, scan_blocks[i]);
    return greatest;
}

// The sum of the numbers of all threads before this one. total receives that of all.
uint sum_before_in_group(uint number, out uint total)
{
    const uint thread = gl_LocalInvocationID.x;
    barrier();
    scan_numbers[thread] = number;
    barrier();
    if (thread < scan_block_count()) {
        uint sum = 0u;
        for (uint i = thread * SCAN_BLOCK; i < min((thread + 1u) * SCAN_BLOCK, group_size()); i++)
            sum += scan_numbers[i];
        scan_blocks[thread] = sum;
    }
    barrier();
    uint before = 0u, block = thread / SCAN_BLOCK;
    total = 0u;
    for (uint i = 0u; i < scan_block_count(); i++) {
        before += i < block ? scan_blocks[i] : 0u;
        total += scan_blocks[i];
    }
    for (uint i = block * SCAN_BLOCK; i < thread; i++)
        before += scan_numbers[i];
    return before;
}
