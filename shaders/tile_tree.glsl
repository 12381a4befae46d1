// SPDX-License-Identifier: MIT
// tile_tree.glsl - how many of some samples each tile gets, and which of its list: as src/sampling/tile_tree.h, but for
// one sample at a time, which finds its way down alone. Needs random.glsl, and of who includes it:
// TREE_IS_EVEN             whether steps are the same for all nodes
// uint tree_sum(uint i)    weights of the tiles before tile i
// uint tree_run(uint run)  first tile of a run of groups, and after the last run the number of all tiles

const uint TREE_RUNS = LAYOUT_TILES_MOST / (LAYOUT_TILE_GROUP * LAYOUT_TILE_RUN);
const uint TREE_NODE_GROUPS = LAYOUT_TILES_MOST;
const uint TREE_NODE_RUNS = TREE_NODE_GROUPS + LAYOUT_TILES_MOST / LAYOUT_TILE_GROUP;
const uint TREE_NODE_ROOT = TREE_NODE_RUNS + TREE_RUNS, TREE_NODE_ORDER = TREE_NODE_ROOT + 1u;

uint tree_random(uint seed, uint node)
{
    return hash(seed + node * 0x9e3779b9u);
}

uint64_t tree_part(uint64_t x, uint fraction)
{
    return (x >> 32) * fraction + (((x & 0xffffffffUL) * fraction) >> 32);
}

// A sample on its way: number `index` of the `count` that the tiles from `begin` to `end` have together.
struct tree_sample {
    uint begin, end, index, count;
};

// Places of a node's samples, in units of 2^-32 of a weight.
struct tree_steps {
    uint64_t start, step;
};

uint64_t common_step; // where steps are the same for all nodes

tree_steps own_steps(uint sum, uint count, uint random)
{
    const uint64_t step = (uint64_t(sum) << 32) / count;
    return tree_steps(tree_part(step, random), step);
}

tree_steps given_steps(uint sum, uint count, uint64_t step, uint random)
{
    const uint64_t whole = uint64_t(sum) << 32, given = count * step;
    if (given > whole)
        return tree_steps(tree_part(whole + step - given, random), step);
    return tree_steps(whole - given + tree_part(step - (whole - given), random), step);
}

tree_steps begin_steps(uint sum, uint count, uint random)
{
    return TREE_IS_EVEN ? given_steps(sum, count, common_step, random) : own_steps(sum, count, random);
}

uint step_at(tree_steps steps, uint index)
{
    return uint((steps.start + index * steps.step) >> 32);
}

uint steps_below(tree_steps steps, uint count, uint sum)
{
    const uint64_t end = uint64_t(sum) << 32;
    return end > steps.start ? min(uint((end - steps.start - 1UL) / steps.step) + 1u, count) : 0u;
}

// To the child from tile `begin` to `end` of the node.
tree_sample child_of(tree_sample s, tree_steps steps, uint begin, uint end)
{
    const uint sum = tree_sum(s.begin), first = steps_below(steps, s.count, tree_sum(begin) - sum);
    return tree_sample(begin, end, s.index - first, steps_below(steps, s.count, tree_sum(end) - sum) - first);
}

// To the child that the sample falls into, of those of `size` tiles each.
tree_sample descend(tree_sample s, uint size, uint random)
{
    const uint before = tree_sum(s.begin);
    const tree_steps steps = begin_steps(tree_sum(s.end) - before, s.count, random);
    const uint place = before + step_at(steps, s.index);
    uint low = 0u, high = (s.end - s.begin + size - 1u) / size;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (tree_sum(s.begin + middle * size) <= place)
            low = middle;
        else
            high = middle;
    }
    const uint begin = s.begin + low * size;
    return child_of(s, steps, begin, min(begin + size, s.end));
}

// The run that a sample of all falls into.
uint find_run(tree_steps steps, uint index)
{
    const uint place = step_at(steps, index);
    uint run = 0u;
    while (tree_sum(tree_run(run + 1u)) <= place)
        run++;
    return run;
}

tree_sample begin_in_run(uint seed, uint index, uint count, out uint run)
{
    const tree_sample all = tree_sample(0u, tree_run(TREE_RUNS), index, count);
    common_step = (uint64_t(tree_sum(all.end)) << 32) / count;
    const tree_steps steps = begin_steps(tree_sum(all.end), count, tree_random(seed, TREE_NODE_ROOT));
    run = find_run(steps, index);
    return child_of(all, steps, tree_run(run), tree_run(run + 1u));
}

// Which of a list of this length a sample is that has come down to the tile at a position.
uint tree_element(tree_sample s, uint seed, uint position, uint length)
{
    return step_at(own_steps(length, s.count, tree_random(seed, position)), s.index);
}
