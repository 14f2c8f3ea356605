// half_counted: The strobe comes exactly half a period after the one before, or after a restart.
reg [10:0] f_since; initial f_since = 11'd2046;
reg [9:0] f_least; initial f_least = 10'd0;
wire [9:0] f_half = period_cycles[10:1];
wire [9:0] f_least_now = (f_half < f_least) ? f_half : f_least;
reg f_adjusted; initial f_adjusted = 1'b1;
always @(posedge clock) begin
    f_least <= f_least_now;
    if (f_since != 11'd2046) f_since <= f_since + 11'd1;
    if (restart | tick_now) begin
        f_since <= 11'd1;
        f_least <= f_half;
        f_adjusted <= shorten | lengthen | began;
    end
    if (reset) begin
        f_since <= 11'd2046;
        f_least <= 10'd0;
        f_adjusted <= 1'b1;
    end
end
always @* begin
    half_counted: assert (!tick_now | f_adjusted | (f_since >= {1'b0, f_least_now}));
    half_counted_so_far: assert (f_adjusted | ({1'b0, count} <= f_since + 11'd1));
    half_counted_hit: assert (!hit | f_adjusted | (f_since >= {1'b0, f_least}));
    half_counted_late: assert (!hit_late | f_adjusted | (f_since >= {1'b0, f_least}));
end
