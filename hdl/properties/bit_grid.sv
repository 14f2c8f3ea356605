// cells_timed: Samples, and edges of what is sent, are exactly a bit apart; the first sample is half a bit after the edge that timed it.
reg [6:0] f_since; initial f_since = 7'd0;
reg [6:0] f_bit; initial f_bit = 7'd0;
reg f_timed; initial f_timed = 1'b0;
always @(posedge clock) begin
    f_since <= f_since + 7'd1;
    if (strobe) f_since <= 7'd1;
    if (f_timed & !strobe & (left == 7'd1)) begin
        f_bit <= bit_cycles;
        f_timed <= (bit_cycles >= 7'd4);
    end
    if (restart) begin
        f_since <= 7'd1;
        f_timed <= (bit_cycles >= 7'd4);
        f_bit <= (bit_cycles >> 1) - 7'd1;
    end
    if (reset) f_timed <= 1'b0;
end
always @* begin
    cells_timed: assert (!strobe | !f_timed | (f_since == f_bit));
    cells_timed_so_far: assert (!f_timed | (left == 7'd1 ? (f_since == 7'd1) : ((left == f_bit + 7'd2 - f_since) & (left >= 7'd2))));
end
