// stored_apart: A reply is stored neither where the processor reads nor over the latest one.
reg [1:0] f_apart; initial f_apart = 2'd0;
always @(posedge clock) begin
    if (ends | reset) f_apart <= 2'd0;
    else if (f_apart != 2'd3) f_apart <= f_apart + 2'd1;
end
// an exchange ends long after the one before
always @* assume (!verdict | clears | (step != 4'd3) | (f_apart == 2'd3));
always @* begin
    stored_apart: assert (!copies | clears | ((free != held) & (free != latest)));
    stored_apart_next: assert (clears | (f_apart == 2'd0) | (step != 4'd3) | ((free != latest) & ((free != held) | (f_apart == 2'd1))));
end
