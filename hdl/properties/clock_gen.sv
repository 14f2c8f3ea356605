// no_short_low: CLOCK is LOW for at least half a period, and for half a period after a hold of it ends, by the shortest period that was set meanwhile.
// no_short_high: CLOCK is HIGH for at least half a period before it falls by itself.
// starts_at_once: A start makes CLOCK LOW in the next cycle, whatever its level was.
reg [10:0] f_age_cycles; initial f_age_cycles = 11'd2046;
reg [9:0] f_shortest; initial f_shortest = 10'd0;
wire [9:0] f_half = period_cycles[10:1];
wire [9:0] f_shortest_now = (f_half < f_shortest) ? f_half : f_shortest;
// cycles counted by the timer so far, from the cycles left
wire [9:0] f_count = f_half + {9'd0, level & period_cycles[0]} + 10'd2 - half_left_cycles;
reg f_past_valid; initial f_past_valid = 1'b0;
reg f_reset; reg f_start;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    f_reset <= reset;
    f_start <= start;
    f_shortest <= f_shortest_now;
    if (f_age_cycles != 11'd2046) f_age_cycles <= f_age_cycles + 11'd1;
    if ((level_next != level) | (hold_low & !level)) begin
        f_age_cycles <= 11'd1;
        f_shortest <= f_half;
    end
    if (reset) begin
        f_age_cycles <= 11'd2046;
        f_shortest <= 10'd0;
    end
end
always @* begin
    no_short_low: assert (level | !level_next | (f_age_cycles >= {1'b0, f_shortest_now}));
    no_short_high: assert (!fall_now | (f_age_cycles >= {1'b0, f_shortest_now}));
    no_short_low_lemma: assert ({1'b0, f_count} <= f_age_cycles + 11'd1);
    starts_at_once: assert (!f_past_valid | f_reset | !f_start | !level);
end
