// lost_trigger_is_told: A trigger that was lost is kept until the result of a trigger tells it.
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset) & $past(lost) & !lost) lost_trigger_is_told: assert ($past(over & !is_own));
end
